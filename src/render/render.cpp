#include "render/render.h"

#include "film/film_stack.h"
#include "render/pass.h"

#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <utility>
#include <vector>

namespace etendue {

namespace {

void check(const RenderSettings& settings) {
  if (settings.samples_per_pixel < 1)
    throw InputError(fmt::format("{} samples a pixel; at least 1 is needed", settings.samples_per_pixel));
  const int replicates = settings.replicate_count();
  if (replicates < 1 || settings.samples_per_pixel % replicates != 0)
    throw InputError(fmt::format("{} samples a pixel cannot be split into {} equal replicates",
                                 settings.samples_per_pixel, replicates));
  // Samples of a pixel, and those of one vertex of each, are numbered by 32 bits.
  const PathRules* rules = settings.integrator.path_rules();
  const std::int64_t numbers = std::int64_t(settings.samples_per_pixel) * (rules ? rules->most_samples() : 1);
  if (numbers > std::int64_t(1) << 32)
    throw InputError(
        fmt::format("{} samples a pixel with {} light or BSDF samples each are {}, more than "
                    "the 4294967296 that can be told apart; take fewer of one of them",
                    settings.samples_per_pixel, rules->most_samples(), numbers));
}

Film film_of(FilmStack&& stack) {
  if (std::optional<Film> film = std::move(stack).take_single()) return std::move(*film);
  Film film(stack.width(), stack.height());
  tbb::parallel_for(0, stack.height(), [&](int y) {
    for (int x = 0; x < stack.width(); ++x) film.at(x, y) = stack.pixel(x, y);
  });
  return film;
}

}  // namespace

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

RenderResult render(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress,
                    const StopRequest* stop) {
  check(settings);
  const auto start = std::chrono::steady_clock::now();
  const int replicates = settings.replicate_count();
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  std::vector<FilmStack> films;  // Of the image, and then of each layer.
  for (std::size_t k = 0; k <= settings.layers.size(); ++k)
    films.emplace_back(scene.camera.width_px, scene.camera.height_px);
  Passes passes(scene, settings, progress, stop);
  RenderCounts counts;
  InvalidSamples invalid;
  bool is_complete = true;
  int done = 0;
  double seconds_per_replicate = passes.measure_pace();
  while (done < replicates && is_complete && !(done > 0 && stop && stop->soon)) {
    const int end = end_of_next_pass(done, replicates, seconds_per_replicate, pixels);
    const PassResult pass = passes.render(films, end);
    counts.samples += pass.counts.samples;
    counts += pass.counts;
    invalid.add(pass.invalid);
    is_complete = pass.is_complete;
    seconds_per_replicate = pass.seconds / (end - done);
    if (is_complete) done = end;
  }
  RenderResult result{.film = film_of(std::move(films.front())),
                      .replicates = int(films.front().last()),
                      .counts = counts,
                      .invalid = invalid,
                      .is_interrupted = done < replicates,
                      .is_fragment = done == 0};
  for (std::size_t k = 1; k < films.size(); ++k) result.layers.push_back(film_of(std::move(films[k])));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace etendue

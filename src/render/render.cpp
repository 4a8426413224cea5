#include "render/render.h"

#include "base/clock.h"
#include "film/film_stack.h"
#include "render/check_settings.h"
#include "render/pass.h"

#include <tbb/task_arena.h>
#include <utility>
#include <vector>

namespace etendue {

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

RenderResult render(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress,
                    const StopRequest* stop) {
  check_settings(settings);
  const Clock::time_point start = Clock::now();
  const int replicates = settings.replicate_count();
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  std::vector<FilmStack> films;  // Of the image, and then of each layer.
  for (std::size_t k = 0; k <= layer_count(settings.layers); ++k)
    films.emplace_back(scene.camera.width_px, scene.camera.height_px);
  ReplicateLuminances luminances;  // Of one replicate alone there is no spread.
  if (replicates > 1) luminances = ReplicateLuminances(scene.camera.width_px, scene.camera.height_px, 0);
  Passes passes(scene, settings, progress, stop);
  RenderCounts counts;
  InvalidSamples invalid;
  std::vector<double> covariances(1 + (settings.noise_parts ? settings.noise_parts->count() : 0));
  std::vector<LargestValues> largest(covariances.size() - 1);
  bool is_complete = true;
  int done = 0;
  // With a second replicate there is an error bar, which a stop waits for if it may.
  const auto must_stop = [&] { return stop && stop->soon; };
  double seconds_per_replicate = passes.measure_pace();
  while (done < replicates && is_complete && !(done > 1 && must_stop())) {
    const int end =
        done == 1 && must_stop() ? 2 : end_of_next_pass(done, replicates, seconds_per_replicate, pixels);
    luminances.make_room(end);
    const PassResult pass = passes.render(films, end, &luminances);
    counts.samples += pass.counts.samples;
    counts += pass.counts;
    invalid.add(pass.invalid);
    for (std::size_t k = 0; k < pass.covariances.size(); ++k) covariances[k] += pass.covariances[k];
    for (std::size_t k = 0; k < pass.largest.size(); ++k) largest[k].add(pass.largest[k]);
    is_complete = pass.is_complete;
    seconds_per_replicate = pass.seconds / (end - done);
    if (is_complete) done = end;
  }
  RenderResult result{.film = passes.take_film(std::move(films.front())),
                      .replicates = int(films.front().last()),
                      .luminances = std::move(luminances),
                      .counts = counts,
                      .invalid = invalid,
                      .is_interrupted = done < replicates,
                      .is_fragment = done == 0};
  for (std::size_t k = 1; k < films.size(); ++k)
    result.layers.push_back(passes.take_film(std::move(films[k])));
  for (std::size_t k = 0; k < largest.size(); ++k)
    result.noise.push_back({covariances[k + 1] / covariances[0], std::move(largest[k])});
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace etendue

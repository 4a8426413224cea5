#include "render/light_budget.h"

#include "base/hash.h"
#include "lightsampler/light_cuts.h"
#include "render/kernel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace etendue {
namespace {

constexpr int side_px = 2;   // Of the squares of pixels that are tried.
constexpr int samples = 16;  // A pixel, in each of the two renders.
constexpr double better_by = 1.5;
constexpr int pixels_a_square = 1024, fewest_squares = 64, most_squares = 2048;

/// About how long a sample takes, in seconds, as measured over scenes of 1e1 to 1e6 triangles: two thirds of
/// it for what is seen, the rest for light samples.
double seconds_of_sample(const Scene& scene, std::int64_t facets, const LightBudget& budget) {
  constexpr std::int64_t swarm = 1 << 16;  // From there on each candidate waits for memory.
  const double ray =
      30e-9 + 4e-9 * std::log2(double(std::max<std::int64_t>(scene.geometry.triangle_count(), 1)));
  const double candidate = facets < swarm ? 35e-9 : 130e-9;
  return 2 * ray + budget.light_samples * (ray + budget.candidates * candidate);
}

/// Squares of pixels, each in a tile of its own that lights are chosen for, scattered over the image.
std::vector<PixelRectangle> squares_of(const Scene& scene, int count) {
  const int width = scene.camera.width_px, height = scene.camera.height_px;
  const int columns = LightCuts::tiles_across(width), tiles = columns * LightCuts::tiles_across(height);
  std::vector<PixelRectangle> squares;
  for (int k = 0; k < std::min(count, tiles); ++k) {
    const std::uint64_t random = hash64(std::uint64_t(k));
    const int tile = int(std::int64_t(k) * tiles / std::min(count, tiles));
    constexpr int places = LightCut::tile_px / side_px;
    const int x = tile % columns * LightCut::tile_px + side_px * int(random % places),
              y = tile / columns * LightCut::tile_px + side_px * int(random / places % places);
    if (x + side_px <= width && y + side_px <= height) squares.push_back({x, y, x + side_px, y + side_px});
  }
  return squares;
}

struct Worker {
  std::unique_ptr<SampleBlock> block = std::make_unique<SampleBlock>();
  std::vector<Color<double>> means;
  InvalidSamples invalid;
};

/// Mean absolute difference of the two replicates of all pixels; none where it was stopped.
std::optional<double> error_of(const Scene& scene, const RenderSettings& settings,
                               const LightSampler& light_sampler, const std::vector<PixelRectangle>& squares,
                               LightCutStore& cuts, const StopRequest* stop) {
  const Kernel& kernel = kernel_for(settings.isa);
  tbb::enumerable_thread_specific<Worker> workers;
  const std::function<bool()> must_stop = [&] { return stop && stop->soon.load(std::memory_order_relaxed); };
  std::vector<double> of_square(squares.size());
  const auto try_square = [&](std::size_t k) {
    if (must_stop()) return;
    Worker& worker = workers.local();
    worker.block->cut_store = &cuts;
    TileJob job{.scene = &scene,
                .light_sampler = &light_sampler,
                .settings = &settings,
                .unit = {.pixels = squares[k], .replicates = 2, .samples_per_replicate = samples},
                .block = worker.block.get(),
                .means = &worker.means,
                .invalid = &worker.invalid};
    kernel.render_tile(job);
    for (std::size_t i = 0; i < worker.means.size(); i += 2)
      of_square[k] += std::abs(luminance(worker.means[i]) - luminance(worker.means[i + 1]));
  };
  const int threads = settings.threads > 0 ? settings.threads : available_threads();
  tbb::task_arena arena(std::min(threads, available_threads()));
  arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, squares.size(), try_square, tbb::simple_partitioner{}); });
  if (must_stop()) return std::nullopt;
  double sum = 0;
  for (const double difference : of_square) sum += difference;
  return sum / double(squares.size() * side_px * side_px);
}

}  // namespace

std::optional<BudgetPilot> light_budget_for(const Scene& scene, const RenderSettings& settings,
                                            const StopRequest* stop) {
  if (!has_open_light_budget(settings.integrator)) return std::nullopt;
  const auto start = std::chrono::steady_clock::now();
  const std::int64_t facets = facet_count(scene.lights);
  const LightBudget usual = light_budget(settled(settings.integrator, scene.lights));
  BudgetPilot pilot{usual, {{usual, 0, 0}}};
  for (const int light_samples : {1, 4})
    for (const int candidates : {1, usual.candidates})
      if (const LightBudget other{light_samples, candidates};
          std::ranges::none_of(pilot.tried, [&](const TriedBudget& known) { return known.budget == other; }))
        pilot.tried.push_back({other, 0, 0});
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  const int wanted = int(std::min(pixels / pixels_a_square, double(most_squares)));
  if (wanted < fewest_squares) return std::nullopt;
  const std::vector<PixelRectangle> squares = squares_of(scene, wanted);
  RenderSettings of_pilot = settings;
  of_pilot.replicates_by = ReplicatesBy::scrambling;
  of_pilot.layers.clear();
  of_pilot.noise_parts.reset();
  of_pilot.seed = hash64(0xb0d9e7);  // The same for all seeds, so that their images have the same budget.
  const LightSampler light_sampler = light_sampler_for(settings.integrator, scene.lights);
  LightCutStore cuts(LightCuts::tiles_across(scene.camera.width_px) *
                     LightCuts::tiles_across(scene.camera.height_px));
  for (TriedBudget& each : pilot.tried) {
    of_pilot.integrator = with_light_budget(settings.integrator, each.budget);
    const std::optional<double> error = error_of(scene, of_pilot, light_sampler, squares, cuts, stop);
    if (!error) return std::nullopt;
    each.error = *error;
    each.seconds = seconds_of_sample(scene, facets, each.budget);
  }
  const auto best = std::ranges::max_element(pilot.tried, {}, &TriedBudget::efficiency);
  if (best->efficiency() > better_by * pilot.tried.front().efficiency()) pilot.chosen = best->budget;
  pilot.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return pilot;
}

}  // namespace etendue

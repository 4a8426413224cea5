#include "render/pilot_squares.h"

#include "base/hash.h"
#include "render/kernel.h"

#include <algorithm>
#include <memory>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace etendue {
namespace {

struct SquareWorker {
  std::unique_ptr<SampleBlock> block = std::make_unique<SampleBlock>();
  std::vector<Color<double>> means;
  InvalidSamples invalid;
};

/// One in a tile, at equal distances in the order of tiles: where these divide a row of tiles, squares stand
/// in a few columns.
std::vector<PixelRectangle> squares_of(const Scene& scene, int count) {
  const int width = scene.camera.width_px, height = scene.camera.height_px;
  const int columns = LightCuts::tiles_across(width), tiles = columns * LightCuts::tiles_across(height);
  std::vector<PixelRectangle> squares;
  for (int k = 0; k < std::min(count, tiles); ++k) {
    const std::uint64_t random = hash64(std::uint64_t(k));
    const int tile = int(std::int64_t(k) * tiles / std::min(count, tiles));
    constexpr int side_px = PilotSquares::side_px, places = LightCut::tile_px / side_px;
    const int x = tile % columns * LightCut::tile_px + side_px * int(random % places),
              y = tile / columns * LightCut::tile_px + side_px * int(random / places % places);
    if (x + side_px <= width && y + side_px <= height) squares.push_back({x, y, x + side_px, y + side_px});
  }
  return squares;
}

}  // namespace

RenderSettings pilot_settings(const RenderSettings& settings, std::uint64_t seed) {
  RenderSettings of_pilot = settings;
  of_pilot.replicates_by = ReplicatesBy::scrambling;
  of_pilot.layers.clear();
  of_pilot.noise_parts.reset();
  of_pilot.seed = hash64(seed);
  return of_pilot;
}

PilotSquares::PilotSquares(const Scene& scene, const RenderSettings& settings, int count)
    : scene_(scene),
      squares_(squares_of(scene, count)),
      light_sampler_(light_sampler_for(settings.integrator, scene.lights)),
      cuts_(LightCuts::tiles_across(scene.camera.width_px) *
            LightCuts::tiles_across(scene.camera.height_px)) {}

std::optional<std::vector<Color<double>>> PilotSquares::render(const RenderSettings& settings, int replicates,
                                                               int samples_per_replicate,
                                                               const StopRequest* stop) {
  const Kernel& kernel = kernel_for(settings.isa);
  tbb::enumerable_thread_specific<SquareWorker> workers;
  const auto must_stop = [&] { return stop && stop->soon.load(std::memory_order_relaxed); };
  const auto means_of_square = std::size_t(pixels * replicates);
  std::vector<Color<double>> means(squares_.size() * means_of_square);
  const auto render_square = [&](std::size_t k) {
    if (must_stop()) return;
    SquareWorker& worker = workers.local();
    worker.block->cut_store = &cuts_;
    TileJob job{.scene = &scene_,
                .light_sampler = &light_sampler_,
                .settings = &settings,
                .unit = {.pixels = squares_[k],
                         .replicates = replicates,
                         .samples_per_replicate = samples_per_replicate},
                .block = worker.block.get(),
                .means = &worker.means,
                .invalid = &worker.invalid};
    kernel.render_tile(job);
    std::ranges::copy(worker.means, means.begin() + std::ptrdiff_t(k * means_of_square));
  };
  const int threads = settings.threads > 0 ? settings.threads : available_threads();
  tbb::task_arena arena(std::min(threads, available_threads()));
  arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, squares_.size(), render_square, tbb::simple_partitioner{}); });
  if (must_stop() || squares_.empty()) return std::nullopt;
  return means;
}

}  // namespace etendue

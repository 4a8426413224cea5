#include "render/pilot_squares.h"

#include "base/hash.h"
#include "render/kernel.h"
#include "sampler/sobol.h"

#include <algorithm>
#include <bit>
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
  RenderCounts counts;
};

}  // namespace

std::vector<PixelRectangle> pilot_squares(int width_px, int height_px, int count) {
  const int columns = LightCuts::tiles_across(width_px), rows = LightCuts::tiles_across(height_px);
  // Of the first 2^(i + j) points of a (0,2)-sequence each cell of a grid of 2^i x 2^j has one.
  const int i = std::bit_width(unsigned(columns - 1)), j = std::bit_width(unsigned(rows - 1));
  std::vector<PixelRectangle> squares;
  for (std::uint64_t k = 0; k >> (i + j) == 0 && squares.size() < std::size_t(count); ++k) {
    const auto point = owen_sobol_2d<std::uint32_t>(std::uint32_t(k), 1, 2, 3);
    const int column = int(std::uint64_t(point.x) >> (32 - i)), row = int(std::uint64_t(point.y) >> (32 - j));
    if (column >= columns || row >= rows) continue;
    const std::uint64_t random = hash64(k);
    constexpr int side_px = PilotSquares::side_px, places = LightCut::tile_px / side_px;
    const int x = column * LightCut::tile_px + side_px * int(random % places),
              y = row * LightCut::tile_px + side_px * int(random / places % places);
    if (x + side_px <= width_px && y + side_px <= height_px)
      squares.push_back({x, y, x + side_px, y + side_px});
  }
  return squares;
}

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
      squares_(pilot_squares(scene.camera.width_px, scene.camera.height_px, count)),
      light_sampler_(light_sampler_for(settings.integrator, scene.lights)),
      cuts_(LightCuts::tiles_across(scene.camera.width_px) *
            LightCuts::tiles_across(scene.camera.height_px)) {}

std::optional<PilotSquares::Rendering> PilotSquares::render(const RenderSettings& settings, int replicates,
                                                            int samples_per_replicate,
                                                            const StopRequest* stop) {
  const Kernel& kernel = kernel_for(settings.isa);
  tbb::enumerable_thread_specific<SquareWorker> workers;
  const auto must_stop = [&] { return stop && stop->soon.load(std::memory_order_relaxed); };
  const auto means_of_square = std::size_t(pixels * replicates);
  Rendering rendering{std::vector<Color<double>>(squares_.size() * means_of_square), {}};
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
    worker.block->counts = {};
    kernel.render_tile(job);
    worker.counts.samples += job.unit.samples();
    worker.counts += worker.block->counts;
    std::ranges::copy(worker.means, rendering.means.begin() + std::ptrdiff_t(k * means_of_square));
  };
  const int threads = settings.threads > 0 ? settings.threads : available_threads();
  tbb::task_arena arena(std::min(threads, available_threads()));
  arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, squares_.size(), render_square, tbb::simple_partitioner{}); });
  if (must_stop() || squares_.empty()) return std::nullopt;
  for (const SquareWorker& worker : workers) {
    rendering.counts.samples += worker.counts.samples;
    rendering.counts += worker.counts;
  }
  return rendering;
}

}  // namespace etendue

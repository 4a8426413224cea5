#include "render/render.h"

#include "render/kernel.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <mutex>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tuple>

namespace etendue {

namespace {

/// Tiles small enough for every thread to have several, and for an interrupt to be obeyed soon.
int tile_side_px(const Camera& camera, int samples_per_pixel, int threads) {
  constexpr int largest = 32, smallest = 4, tiles_a_thread = 8;
  constexpr double most_samples = 4e6;
  int side = largest;
  const auto is_coarse = [&] {
    return double(camera.width_px) * camera.height_px < double(side) * side * threads * tiles_a_thread ||
           double(side) * side * samples_per_pixel > most_samples;
  };
  while (side > smallest && is_coarse()) side /= 2;
  return side;
}

/// One thread's scratch and counts.
struct Worker {
  std::unique_ptr<SampleBlock> block = std::make_unique<SampleBlock>();
  std::vector<InvalidSample> invalid;
  std::int64_t samples = 0, invalid_samples = 0;
};

void check(const RenderSettings& settings) {
  if (settings.samples_per_pixel < 1)
    throw InputError(fmt::format("{} samples a pixel; at least 1 is needed", settings.samples_per_pixel));
  if (settings.replicates < 1 || settings.samples_per_pixel % settings.replicates != 0)
    throw InputError(fmt::format("{} samples a pixel cannot be split into {} equal replicates",
                                 settings.samples_per_pixel, settings.replicates));
}

bool is_before(const InvalidSample& a, const InvalidSample& b) {
  return std::tie(a.y, a.x, a.replicate, a.index) < std::tie(b.y, b.x, b.replicate, b.index);
}

}  // namespace

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

RenderResult render(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress,
                    const std::atomic<bool>* stop) {
  check(settings);
  const Kernel& kernel = kernel_for(settings.isa);
  RenderResult result{Film(scene.camera.width_px, scene.camera.height_px), {}, {}, 0, false};
  const int threads = settings.threads > 0 ? settings.threads : available_threads();
  const int side = tile_side_px(scene.camera, settings.samples_per_pixel, threads);
  const int columns = (scene.camera.width_px + side - 1) / side,
            rows = (scene.camera.height_px + side - 1) / side;
  const auto start = std::chrono::steady_clock::now();
  const LightSampler light_sampler = light_sampler_for(settings.integrator, scene.lights);

  tbb::enumerable_thread_specific<Worker> workers;
  std::atomic<int> tiles_done{0};
  std::mutex progress_mutex;
  const auto render_tile = [&](int tile) {
    if (stop && stop->load(std::memory_order_relaxed)) return;
    Worker& worker = workers.local();
    const int x = tile % columns * side, y = tile / columns * side;
    TileJob job{.scene = &scene,
                .light_sampler = &light_sampler,
                .settings = &settings,
                .x_begin = x,
                .y_begin = y,
                .x_end = std::min(x + side, scene.camera.width_px),
                .y_end = std::min(y + side, scene.camera.height_px),
                .block = worker.block.get(),
                .film = &result.film,
                .invalid = &worker.invalid,
                .stop = stop};
    kernel.render_tile(job);
    worker.samples += job.samples;
    worker.invalid_samples += job.invalid_samples;
    if (job.is_stopped) return;
    ++tiles_done;
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(double(tiles_done) / (columns * rows));
  };
  tbb::task_arena arena(threads);
  arena.execute([&] { tbb::parallel_for(0, columns * rows, render_tile, tbb::simple_partitioner{}); });

  for (const Worker& worker : workers) {
    result.counts.samples += worker.samples;
    result.counts += worker.block->counts;
    result.counts.invalid_samples += worker.invalid_samples;
    result.invalid.insert(result.invalid.end(), worker.invalid.begin(), worker.invalid.end());
  }
  std::sort(result.invalid.begin(), result.invalid.end(), is_before);
  result.invalid.resize(std::min(result.invalid.size(), most_invalid_noted));
  result.is_interrupted = tiles_done < columns * rows;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace etendue

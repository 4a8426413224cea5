#include "render/pass.h"

#include "base/clock.h"
#include "film/part_covariances.h"

#include <algorithm>
#include <bit>
#include <mutex>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <utility>

namespace etendue {

namespace {

/// One thread's scratch, and what it has put into the film in the pass.
struct TileWorker {
  std::unique_ptr<SampleBlock> block = std::make_unique<SampleBlock>();
  std::vector<Color<double>> means;
  InvalidSamples invalid_of_tile, invalid;
  RenderCounts counts;
  std::vector<LargestValues> largest;  ///< Of each noise part.
};

/// Whether a pass goes on: asked by all threads, often.
class StopWatch {
 public:
  /// \param is_needed is worth waiting for
  /// \param expected_seconds that the pass takes, where it is known beforehand
  /// \param requested_at when a stop was first seen, by this pass or one before; none at first
  StopWatch(const StopRequest* request, bool is_needed, std::size_t tiles,
            std::optional<double> expected_seconds, std::atomic<double>& requested_at)
      : request_(request),
        is_needed_(is_needed),
        tiles_(tiles),
        expected_seconds_(expected_seconds),
        requested_at_(requested_at) {}

  bool must_stop() {
    if (!request_ || !request_->soon.load(std::memory_order_relaxed)) return false;
    return !is_needed_ || request_->now.load(std::memory_order_relaxed) || takes_too_long();
  }

  void count_tile() { ++tiles_done_; }
  std::size_t tiles_done() const { return tiles_done_; }

  /// Of the pass; none where the first tile is not done and nothing was expected.
  std::optional<double> seconds_left() const {
    const std::size_t done = tiles_done_;
    if (done == 0) {
      if (!expected_seconds_) return std::nullopt;
      return std::max(0.0, *expected_seconds_ - seconds_since(start_));
    }
    return seconds_since(start_) * double(tiles_ - done) / double(done);
  }
  bool is_waiting_for_pass() const { return request_ && request_->soon && is_needed_; }

 private:
  /// Where little is left the pass may come to its end, though the estimate was too low.
  bool takes_too_long() {
    constexpr double most_seconds = 10, most_seconds_once_begun = 20;
    const std::optional<double> left = seconds_left();
    const double all = left.value_or(0) + seconds_since_request();
    if (left && all <= most_seconds) has_little_left_ = true;
    return all > (has_little_left_ ? most_seconds_once_begun : most_seconds);
  }

  double seconds_since_request() {
    const double now = seconds_since({});
    double none = 0;
    requested_at_.compare_exchange_strong(none, now);
    return now - requested_at_;
  }

  const StopRequest* request_;
  const bool is_needed_;
  const std::size_t tiles_;
  const std::optional<double> expected_seconds_;
  const Clock::time_point start_ = Clock::now();
  std::atomic<std::size_t> tiles_done_{0};
  std::atomic<double>& requested_at_;
  std::atomic<bool> has_little_left_{false};
};

std::vector<LayerSet> layer_sets_of(const RenderSettings& settings) {
  std::vector<LayerSet> sets = settings.layers;
  if (settings.noise_parts) sets.push_back(*settings.noise_parts);
  return sets;
}

}  // namespace

struct Passes::Threads {
  const Scene& scene;
  const RenderSettings settings;
  const ProgressCallback& progress;
  const StopRequest* stop;
  const Kernel& kernel;
  const LightSampler light_sampler;
  const int count;
  LightCutStore cuts;
  tbb::task_arena arena;
  const std::vector<LayerSet> layer_sets = layer_sets_of(settings);
  const std::size_t noise_parts = settings.noise_parts ? settings.noise_parts->count() : 0;
  PartCovariances noise{noise_parts > 0 ? scene.camera.width_px : 0, scene.camera.height_px, noise_parts};
  tbb::enumerable_thread_specific<TileWorker> workers{};
  std::optional<double> seconds_per_replicate{};  ///< As the last pass took.
  std::atomic<double> stop_requested_at{0};       ///< Of Clock; 0: not seen yet.

  /// False where it was stopped: nothing of the tile is in the film then.
  /// \param covariances of the tile: the image, and each noise part
  bool render_tile(const WorkUnit& tile, const std::function<bool()>& must_stop,
                   std::vector<FilmStack>& films, ReplicateLuminances* luminances,
                   std::span<double> covariances) {
    if (must_stop()) return false;
    TileWorker& worker = workers.local();
    worker.block->cut_store = &cuts;
    worker.largest.resize(noise_parts);
    TileJob job{.scene = &scene,
                .light_sampler = &light_sampler,
                .settings = &settings,
                .layer_sets = layer_sets,
                .unit = tile,
                .block = worker.block.get(),
                .means = &worker.means,
                .invalid = &worker.invalid_of_tile,
                .largest = worker.largest,
                .must_stop = &must_stop};
    worker.block->counts = {};
    worker.invalid_of_tile = {};
    kernel.render_tile(job);
    if (job.is_stopped) return false;
    const Color<double>* means = worker.means.data();
    const FilmStack& of_luminances = films[settings.keeps_luminances_of_layer ? 1 : 0];
    for (FilmStack& film : films)
      for (int y = tile.pixels.y_begin; y < tile.pixels.y_end; ++y)
        for (int x = tile.pixels.x_begin; x < tile.pixels.x_end; ++x, means += tile.replicates) {
          const std::span<const Color<double>> of_pixel(means, std::size_t(tile.replicates));
          film.add(x, y, of_pixel);
          if (luminances && &film == &of_luminances) luminances->add(x, y, tile.first_replicate, of_pixel);
        }
    if (noise_parts > 0) add_to_noise(tile, worker.means, covariances);
    worker.counts.samples += tile.samples();
    worker.counts += worker.block->counts;
    worker.invalid.add(worker.invalid_of_tile);
    return true;
  }

  /// \param means of the tile's replicates: of the image, its layers and its noise parts
  void add_to_noise(const WorkUnit& tile, std::span<const Color<double>> means,
                    std::span<double> covariances) {
    const auto replicates = std::size_t(tile.replicates);
    const std::size_t of_image = means.size() / (1 + layer_count(layer_sets));
    const Color<double>* image = means.data();
    const Color<double>* parts = means.data() + means.size() - noise_parts * of_image;
    for (int y = tile.pixels.y_begin; y < tile.pixels.y_end; ++y)
      for (int x = tile.pixels.x_begin; x < tile.pixels.x_end; ++x, image += replicates, parts += replicates)
        noise.add(x, y, {image, replicates}, parts, of_image, covariances);
  }

  /// Of all workers, which begin anew.
  void take_counts(PassResult& result) {
    result.largest.resize(noise_parts);
    for (TileWorker& worker : workers) {
      result.counts.samples += worker.counts.samples;
      result.counts += worker.counts;
      result.invalid.add(worker.invalid);
      for (std::size_t k = 0; k < worker.largest.size(); ++k) result.largest[k].add(worker.largest[k]);
      worker.counts = {};
      worker.invalid = {};
      worker.largest.clear();
    }
  }
};

Passes::Passes(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress,
               const StopRequest* stop) {
  const int threads = settings.threads > 0 ? settings.threads : available_threads();
  RenderSettings settled_settings = settings;
  settled_settings.integrator = settled(settings.integrator, scene.lights);
  threads_.reset(new Threads{scene, settled_settings, progress, stop, kernel_for(settings.isa),
                             light_sampler_for(settings.integrator, scene.lights), threads,
                             LightCutStore(LightCuts::tiles_across(scene.camera.width_px) *
                                           LightCuts::tiles_across(scene.camera.height_px)),
                             // TBB gives no more than there are, and says on stderr that it does not.
                             tbb::task_arena(std::min(threads, available_threads()))});
}

Passes::~Passes() = default;

double Passes::measure_pace() {
  Threads& threads = *threads_;
  constexpr int side_px = 8, along = 4;
  constexpr double most_seconds = 0.05;
  const int width = threads.scene.camera.width_px, height = threads.scene.camera.height_px;
  const Clock::time_point start = Clock::now();
  TileWorker worker;
  double measured = 0;
  for (int k = 0; k < along * along && seconds_since(start) < most_seconds; ++k) {
    const int x = (2 * (k % along) + 1) * width / (2 * along),
              y = (2 * (k / along) + 1) * height / (2 * along);
    TileJob job{.scene = &threads.scene,
                .light_sampler = &threads.light_sampler,
                .settings = &threads.settings,
                .unit = {.pixels = {x, y, std::min(x + side_px, width), std::min(y + side_px, height)},
                         .samples_per_replicate = std::min(threads.settings.samples_per_replicate(), 16)},
                .block = worker.block.get(),
                .means = &worker.means,
                .invalid = &worker.invalid_of_tile};
    threads.kernel.render_tile(job);
    measured += double(job.unit.pixels.width()) * job.unit.pixels.height() * job.unit.samples_per_replicate;
  }
  const double samples = double(width) * height * threads.settings.samples_per_replicate();
  return seconds_since(start) / measured * samples / threads.count;
}

PassResult Passes::render(std::vector<FilmStack>& films, int end, ReplicateLuminances* luminances) {
  Threads& threads = *threads_;
  const FilmStack& film = films.front();
  const int first = int(film.last());
  const std::vector<WorkUnit> tiles =
      tiles_of({.pixels = {0, 0, film.width(), film.height()},
                .first_replicate = first,
                .replicates = end - first,
                .samples_per_replicate = threads.settings.samples_per_replicate(),
                .allocation = threads.settings.allocation_or_null()},
               threads.count);
  const bool is_first_pass = film.last() == film.first();
  const Clock::time_point start = Clock::now();
  const bool is_needed = film.last() - film.first() < 2;  // One replicate alone has no error bar.
  const std::optional<double> expected_seconds =
      threads.seconds_per_replicate ? std::optional(*threads.seconds_per_replicate * (end - first))
                                    : std::nullopt;
  StopWatch watch(threads.stop, is_needed, tiles.size(), expected_seconds, threads.stop_requested_at);
  const std::function<bool()> must_stop = [&] { return watch.must_stop(); };
  std::mutex progress_mutex;
  for (FilmStack& each : films) each.begin_pass(std::uint64_t(end));
  // By tile, so that sums do not depend on the threads' order.
  const std::size_t sums = 1 + threads.noise_parts;
  std::vector<double> covariances(tiles.size() * sums);
  const auto render_tile = [&](std::size_t k) {
    if (!threads.render_tile(tiles[k], must_stop, films, luminances,
                             std::span(covariances).subspan(k * sums, sums)))
      return;
    watch.count_tile();
    if (!threads.progress) return;
    const std::lock_guard lock(progress_mutex);
    const double of_pass = double(watch.tiles_done()) / double(tiles.size());
    threads.progress({(first + of_pass * (end - first)) / threads.settings.replicate_count(),
                      watch.is_waiting_for_pass() ? watch.seconds_left() : std::nullopt});
  };
  threads.arena.execute(
      [&] { tbb::parallel_for(std::size_t{0}, tiles.size(), render_tile, tbb::simple_partitioner{}); });

  PassResult result;
  threads.take_counts(result);
  result.covariances.resize(sums);
  for (std::size_t k = 0; k < covariances.size(); ++k) result.covariances[k % sums] += covariances[k];
  result.is_complete = watch.tiles_done() == tiles.size();
  if (result.is_complete || is_first_pass)
    for (FilmStack& each : films) each.commit_pass();
  else
    result = {};
  result.seconds = seconds_since(start);
  threads.seconds_per_replicate = result.seconds / (end - first);
  return result;
}

Film Passes::take_film(FilmStack&& stack) {
  if (std::optional<Film> film = std::move(stack).take_single()) return std::move(*film);
  Film film(stack.width(), stack.height());
  threads_->arena.execute([&] {
    tbb::parallel_for(0, stack.height(), [&](int y) {
      for (int x = 0; x < stack.width(); ++x) film.at(x, y) = stack.pixel(x, y);
    });
  });
  return film;
}

int end_of_next_pass(int done, int replicates, double seconds_per_replicate, double pixels) {
  constexpr double most = 1024;  // A thread keeps as many means for each pixel of its tile.
  const double wanted = (1 + 4e-7 * pixels) / std::max(seconds_per_replicate, 1e-9);
  const int left = replicates - done;
  if (left <= most && left <= 2 * wanted) return replicates;
  const std::int64_t step = std::bit_floor(unsigned(std::clamp(wanted, 1.0, most)));
  return int(std::min<std::int64_t>((done / step + 1) * step, replicates));
}

}  // namespace etendue

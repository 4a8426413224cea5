// The one source that holds the wide code; built once for each instruction set, see
// cmake/EtendueModules.cmake.
#include "render/kernel.h"

#include "integrator/run_integrator.h"
#include "render/pixel_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace etendue {

namespace {

using F = NativeLanes;

/// Counts and notes samples that are not finite and >= 0, and makes them 0 so that they do not poison their
/// pixel. A control variate may make a sample negative.
void set_invalid_aside(TileJob& job, SampleBlock& block, const PixelBlocks& pixels) {
  ColorColumn& radiance = block.radiance;
  const PathRules* rules = job.settings->integrator.path_rules();
  const bool may_be_negative = rules && rules->alpha(0);
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    Color<F> c = load_lanes<F>(radiance, i);
    if (may_be_negative) c = {abs(c.r), abs(c.g), abs(c.b)};
    if (all(mask_and(is_finite_nonnegative(c.r), is_finite_nonnegative(c.g), is_finite_nonnegative(c.b))))
      continue;
    for (int s = i; s < i + lane_count_v<F>; ++s) {
      const Colorf sample{radiance.r[s], radiance.g[s], radiance.b[s]};
      const auto is_valid = [&](float x) { return is_finite_nonnegative(may_be_negative ? std::abs(x) : x); };
      if (is_valid(sample.r) && is_valid(sample.g) && is_valid(sample.b)) continue;
      radiance.r[s] = radiance.g[s] = radiance.b[s] = 0;
      for (ColorColumn& layer : block.layers) layer.r[s] = layer.g[s] = layer.b[s] = 0;
      if (s >= block.count) continue;
      job.invalid->add(
          {block.pixel_x[s], block.pixel_y[s], pixels.replicate_of(s), pixels.index_of(s), sample});
    }
  }
}

/// Luminances of the samples' parts that are in layers, without the filter's weights.
void note_largest(const SampleBlock& block, std::span<LargestValues> largest) {
  const std::span layers = std::span(block.layers).last(largest.size());
  for (std::size_t k = 0; k < layers.size(); ++k) {
    alignas(64) std::array<float, lane_count_v<F>> each;
    F positive(0);
    for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
      const F values = luminance(load_lanes<F>(layers[k], i));
      positive = positive + select(values > F(0), F(1), F(0));
      if (!any(values > F(largest[k].threshold()))) continue;
      store_lanes(each.data(), values);
      for (int s = i; s < std::min(i + lane_count_v<F>, block.count); ++s)
        largest[k].add(each[std::size_t(s - i)]);
    }
    store_lanes(each.data(), positive);
    largest[k].count(std::int64_t(std::accumulate(each.begin(), each.end(), 0.0f)));
  }
}

void render_tile(TileJob& job) {
  SampleBlock& block = *job.block;
  block.layer_sets = job.layer_sets;
  block.layers.resize(layer_count(job.layer_sets));
  PixelBlocks pixels(job, block.layers.size());
  block.clock.start();
  while (pixels.next(block)) {
    if (job.must_stop && (*job.must_stop)()) {
      job.is_stopped = true;
      return;
    }
    run_integrator<F>(job.settings->integrator, *job.scene, *job.light_sampler, block,
                      job.settings->is_reordering);
    set_invalid_aside(job, block, pixels);
    note_largest(block, job.largest);
    weigh_by_filter<F>(*job.scene, block);
    pixels.take_means(block);
    block.clock.finish(Stage::sums);
    if (job.on_block) {
      (*job.on_block)(block);
      block.clock.start();
    }
  }
}

constexpr Kernel kernel{lane_count_v<F>, render_tile};

}  // namespace

}  // namespace etendue

extern "C" __attribute__((visibility("default"))) const etendue::Kernel* etendue_kernel();
const etendue::Kernel* etendue_kernel() { return &etendue::kernel; }

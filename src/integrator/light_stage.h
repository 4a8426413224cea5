// The light stages: sample the lights, aim the shadow rays, add what nothing hides.
#pragma once

#include "base/frame.h"
#include "bsdf/bsdf.h"
#include "integrator/camera_stage.h"
#include "integrator/light_sampling.h"
#include "integrator/mis_weights.h"
#include "integrator/sample_block.h"
#include "integrator/surface_point.h"

#include <algorithm>
#include <array>
#include <utility>

namespace etendue {

/// For each sample: a light sample, its shadow segment, and what it adds to the radiance where it is visible.
template <class F>
void sample_lights(const Scene& scene, SampleBlock& block, Combination combination) {
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const SurfacePoint<F> surface(scene, block.camera_ray, block.camera_hit, i);
    if (!any(surface.is_there)) {
      store_lanes(&block.shadow_is_needed[i], Int<F>(0));
      continue;
    }
    const Vec2<UInt<F>> u_light = sample_bits<F>(scene, block, i, dimension::light);
    const LightSample<F> sample = sample_lights<F>(scene, surface.position, u_light, surface.is_there);

    const Frame<F> frame(surface.ns);
    const Vec3<F> wo_local = frame.local_from_world(surface.wo), wi_local = frame.local_from_world(sample.wi);
    const Mask<F> is_lit = mask_and(sample.is_there, surface.reflects_towards(sample.wi));
    Color<F> reflected = black<F>();
    for_each_material<F>(scene.materials, surface.material, Vec2<F>{F(0), F(0)}, is_lit,
                         [&](const auto& bsdf, const Mask<F>& lanes) {
                           const F weight =
                               needs_both_pdfs(combination)
                                   ? mis_weight(combination, select(lanes, sample.pdf_solid_angle(), F(1)),
                                                bsdf.pdf_solid_angle_(wo_local, wi_local))
                                   : mis_weight(combination, F(1), F(1));
                           const Color<F> f = bsdf.eval_(wo_local, wi_local) * sample.radiance_over_pdf *
                                              (wi_local.z * weight);
                           reflected = select(lanes, f, reflected);
                         });

    store_lanes(block.unshadowed, i, reflected);
    // Not "greater than 0": a NaN must reach the sum, where it is reported.
    store_mask<F>(&block.shadow_is_needed[i], mask_and(is_lit, mask_not(is_black(reflected))));
    const Vec3<F> origin = surface.offset_origin();
    store_lanes(block.shadow_origin, i, origin);
    store_lanes(block.shadow_direction, i, sample.end - origin);
    store_lanes(&block.aim[i], sample.light * Int<F>(light_pieces) + sample.piece);
  }
  block.clock.finish(Stage::light_samples);
}

/// Orders the shadow rays that are needed so that a packet goes from one part of the block's pixels to one
/// piece of one light: a counting sort. Order only: results go back to the sample's place.
inline void aim_shadow_rays(const Scene& scene, SampleBlock& block) {
  // A packet is coherent where both its ends are near each other: a block of many pixels, which come in
  // Morton order, is split into quarters and each light into few pieces; a block of one pixel, each light
  // into many.
  constexpr std::int32_t most_bins = 256;
  const std::int32_t quarters = block.is_one_pixel ? 1 : 4, piece_shift = block.is_one_pixel ? 0 : 2;
  const std::int32_t aims = scene.lights.count() * (light_pieces >> piece_shift);
  int shift = 0;
  while (((aims - 1) >> shift) >= most_bins / quarters) ++shift;
  const std::int32_t bins_a_quarter = ((aims - 1) >> shift) + 1, used_bins = quarters * bins_a_quarter;

  // Rays that are not needed go to a bin behind all others: no branch to mispredict.
  const int quarter_size = (block.count + quarters - 1) / quarters, aim_shift = piece_shift + shift;
  for (std::int32_t quarter = 0; quarter < quarters; ++quarter) {
    const int begin = std::min(block.count, quarter * quarter_size);
    const int end = std::min(block.count, begin + quarter_size);
    const std::int32_t first_bin = quarter * bins_a_quarter;
    for (int i = begin; i < end; ++i) {
      const std::int32_t bin = first_bin + (block.aim[i] >> aim_shift);
      block.aim[i] = (bin & block.shadow_is_needed[i]) | (used_bins & ~block.shadow_is_needed[i]);
    }
  }
  // Two counts, of even and odd samples, so that neighbours in one bin need not wait for each other.
  std::array<std::array<std::int32_t, most_bins + 1>, 2> next{};
  const std::int32_t* bins = block.aim.data();
  const int even_count = block.count / 2 * 2;
  for (int i = 0; i < even_count; i += 2) {
    ++next[0][std::size_t(bins[i])];
    ++next[1][std::size_t(bins[i + 1])];
  }
  if (even_count < block.count) ++next[0][std::size_t(bins[even_count])];
  std::int32_t total = 0;
  for (std::int32_t bin = 0; bin <= used_bins; ++bin) {
    if (bin == used_bins) block.shadow_count = total;
    for (auto& half : next) total += std::exchange(half[std::size_t(bin)], total);
  }
  for (int i = 0; i < even_count; i += 2) {
    block.order[std::size_t(next[0][std::size_t(bins[i])]++)] = i;
    block.order[std::size_t(next[1][std::size_t(bins[i + 1])]++)] = i + 1;
  }
  if (even_count < block.count)
    block.order[std::size_t(next[0][std::size_t(bins[even_count])]++)] = even_count;
  block.clock.finish(Stage::aiming);
}

/// The same rays in sample order: to show that the order changes no result.
inline void keep_shadow_rays_in_order(SampleBlock& block) {
  block.shadow_count = 0;
  for (int i = 0; i < block.count; ++i)
    if (block.shadow_is_needed[i]) block.order[std::size_t(block.shadow_count++)] = i;
  block.clock.finish(Stage::aiming);
}

/// Casts the shadow rays in their order and adds the light samples that nothing hides.
template <class F>
void add_unshadowed(const Scene& scene, SampleBlock& block, Coherence coherence) {
  int padded = block.shadow_count;
  while (padded % lane_count_v<F> != 0) block.order[std::size_t(padded++)] = -1;
  const SegmentSpan segments{block.shadow_origin.x.data(),
                             block.shadow_origin.y.data(),
                             block.shadow_origin.z.data(),
                             block.shadow_direction.x.data(),
                             block.shadow_direction.y.data(),
                             block.shadow_direction.z.data(),
                             block.order.data(),
                             padded,
                             shadow_segment_end};
  block.shadow_is_free.fill(0);
  scene.rays.unoccluded(segments, block.shadow_is_free.data(), lane_count_v<F>, coherence);
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Mask<F> is_free = load_mask<F>(&block.shadow_is_free[i]);
    if (!any(is_free)) continue;
    const Color<F> direct = select(is_free, load_lanes<F>(block.unshadowed, i), black<F>());
    store_lanes(block.radiance, i, load_lanes<F>(block.radiance, i) + direct);
  }
  block.shadow_rays += block.shadow_count;
  block.clock.finish(Stage::shadow_rays);
}

/// All of the above, as integrators that sample lights use it.
template <class F>
void add_light_samples(const Scene& scene, SampleBlock& block, Combination combination, bool is_reordering) {
  sample_lights<F>(scene, block, combination);
  if (is_reordering)
    aim_shadow_rays(scene, block);
  else
    keep_shadow_rays_in_order(block);
  const bool is_coherent = is_reordering && scene.lights.are_aimed_packets_coherent();
  add_unshadowed<F>(scene, block, is_coherent ? Coherence::coherent : Coherence::incoherent);
}

}  // namespace etendue

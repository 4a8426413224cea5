// The order in which shadow rays are cast: packets that start in one place and aim at one piece of one light.
#pragma once

#include "integrator/sample_block.h"
#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <utility>

namespace etendue {

/// The parts of a block whose shadow rays are ordered each by itself: of one that has many pixels, which come
/// in Morton order, the quarters.
inline std::int32_t aimed_parts(const SampleBlock& block) { return block.is_one_pixel ? 1 : 4; }

/// Whether ordering the shadow rays makes them faster: they start near each other, as those of later vertices
/// do not, and enough of them aim at one light, else a packet starts all over its part and aims at many. The
/// least number is measured (docs/performance.md).
/// \param lights among which each ray has chosen its own
inline bool is_worth_aiming(const SampleBlock& block, int vertex, std::int32_t lights) {
  constexpr std::int32_t least_rays = 6;
  return vertex == 0 && block.path.count / (least_rays * aimed_parts(block)) >= lights;
}

/// Whether shadow packets that aim at one piece of one light are best traced as one: not where most lights
/// are finely built. Most lights are taken for most rays.
inline bool are_aimed_packets_coherent(const Lights& lights) {
  return 2 * lights.table<MeshLights>().finely_built_count() <= lights.count();
}

/// Orders the shadow rays that are needed so that a packet goes from one part of the block's pixels to one
/// piece of one light: a counting sort. Order only: results go back to the sample's place.
inline void aim_shadow_rays(const Scene& scene, SampleBlock& block) {
  // A packet is coherent where both its ends are near each other: a block of many pixels, which come in
  // Morton order, is split into quarters and each light into few pieces; a block of one pixel, each light
  // into many.
  constexpr std::int32_t most_bins = 256;
  const std::int32_t quarters = aimed_parts(block), piece_shift = block.is_one_pixel ? 0 : 2;
  const std::int32_t aims = scene.lights.count() * (light_pieces >> piece_shift);
  int shift = 0;
  while (((aims - 1) >> shift) >= most_bins / quarters) ++shift;
  const std::int32_t bins_a_quarter = ((aims - 1) >> shift) + 1, used_bins = quarters * bins_a_quarter;

  // Rays that are not needed go to a bin behind all others: no branch to mispredict.
  const int quarter_size = (block.path.count + quarters - 1) / quarters, aim_shift = piece_shift + shift;
  for (std::int32_t quarter = 0; quarter < quarters; ++quarter) {
    const int begin = std::min(block.path.count, quarter * quarter_size);
    const int end = std::min(block.path.count, begin + quarter_size);
    const std::int32_t first_bin = quarter * bins_a_quarter;
    for (int i = begin; i < end; ++i) {
      const std::int32_t aim = block.shadow_light[i] * light_pieces + block.shadow_piece[i];
      const std::int32_t bin = first_bin + (aim >> aim_shift);
      block.bin[i] = (bin & block.shadow_is_needed[i]) | (used_bins & ~block.shadow_is_needed[i]);
    }
  }
  // Two counts, of even and odd samples, so that neighbours in one bin need not wait for each other.
  std::array<std::array<std::int32_t, most_bins + 1>, 2> next{};
  const std::int32_t* bins = block.bin.data();
  const int even_count = block.path.count / 2 * 2;
  for (int i = 0; i < even_count; i += 2) {
    ++next[0][std::size_t(bins[i])];
    ++next[1][std::size_t(bins[i + 1])];
  }
  if (even_count < block.path.count) ++next[0][std::size_t(bins[even_count])];
  std::int32_t total = 0;
  for (std::int32_t bin = 0; bin <= used_bins; ++bin) {
    if (bin == used_bins) block.shadow_count = total;
    for (auto& half : next) total += std::exchange(half[std::size_t(bin)], total);
  }
  for (int i = 0; i < even_count; i += 2) {
    block.order[std::size_t(next[0][std::size_t(bins[i])]++)] = i;
    block.order[std::size_t(next[1][std::size_t(bins[i + 1])]++)] = i + 1;
  }
  if (even_count < block.path.count)
    block.order[std::size_t(next[0][std::size_t(bins[even_count])]++)] = even_count;
  block.clock.finish(Stage::aiming);
}

/// The same rays in sample order: to show that the order changes no result.
inline void keep_shadow_rays_in_order(SampleBlock& block) {
  block.shadow_count = 0;
  for (int i = 0; i < block.path.count; ++i)
    if (block.shadow_is_needed[i]) block.order[std::size_t(block.shadow_count++)] = i;
  block.clock.finish(Stage::aiming);
}

}  // namespace etendue

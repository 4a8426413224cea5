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
/// \param samples of the lights that a path takes at once \param lights among which each ray has chosen its
/// own
inline bool is_worth_aiming(const SampleBlock& block, int vertex, int samples, std::int32_t lights) {
  constexpr std::int32_t least_rays = 6;
  return vertex == 0 && samples * block.path.count / (least_rays * aimed_parts(block)) >= lights;
}

/// Whether shadow packets that aim at one piece of one light are best traced as one: not where most lights
/// are finely built. Most lights are taken for most rays.
inline bool are_aimed_packets_coherent(const Lights& lights) {
  return 2 * lights.table<MeshLights>().finely_built_count() <= lights.count();
}

/// Orders the shadow rays that are needed so that a packet goes from one part of the block's pixels to one
/// piece of one light, or to lights of neighbouring ranks: a counting sort. Order only: results go back to
/// the sample's place.
inline void aim_shadow_rays(SampleBlock& block, std::int32_t ranks) {
  // A packet is coherent where both its ends are near each other: a block of many pixels, which come in
  // Morton order, is split into quarters and each light into few pieces; a block of one pixel, each light
  // into many.
  constexpr std::int32_t most_bins = 1024;
  const std::int32_t quarters = aimed_parts(block), piece_shift = block.is_one_pixel ? 0 : 2;
  const std::int32_t aims = ranks * (light_pieces >> piece_shift);
  int shift = 0;
  while (((aims - 1) >> shift) >= most_bins / quarters) ++shift;
  const std::int32_t bins_a_quarter = ((aims - 1) >> shift) + 1, used_bins = quarters * bins_a_quarter;

  // Rays that are not needed go to a bin behind all others: no branch to mispredict.
  ShadowRays& shadow = block.shadow;
  const int quarter_size = (block.path.count + quarters - 1) / quarters, aim_shift = piece_shift + shift;
  for (int k = 0; k < shadow.samples; ++k) {
    for (std::int32_t quarter = 0; quarter < quarters; ++quarter) {
      const int begin = std::min(block.path.count, quarter * quarter_size);
      const int end = std::min(block.path.count, begin + quarter_size);
      const std::int32_t first_bin = quarter * bins_a_quarter;
      for (int row = shadow.row(k, begin); row < shadow.row(k, end); ++row) {
        const std::int32_t bin = first_bin + (shadow.aim[row] >> aim_shift);
        shadow.bin[row] = (bin & shadow.is_needed[row]) | (used_bins & ~shadow.is_needed[row]);
      }
    }
    for (int i = block.path.count; i < shadow.stride; ++i) shadow.bin[shadow.row(k, i)] = used_bins;
  }
  // Two counts, of even and odd rows, so that neighbours in one bin need not wait for each other.
  std::array<std::array<std::int32_t, most_bins + 1>, 2> next{};
  const std::int32_t* bins = shadow.bin.data();
  const int even_rows = shadow.rows() / 2 * 2;
  for (int row = 0; row < even_rows; row += 2) {
    ++next[0][std::size_t(bins[row])];
    ++next[1][std::size_t(bins[row + 1])];
  }
  if (even_rows < shadow.rows()) ++next[0][std::size_t(bins[even_rows])];
  std::int32_t total = 0;
  for (std::int32_t bin = 0; bin <= used_bins; ++bin) {
    if (bin == used_bins) shadow.count = total;
    for (auto& half : next) total += std::exchange(half[std::size_t(bin)], total);
  }
  for (int row = 0; row < even_rows; row += 2) {
    shadow.order[std::size_t(next[0][std::size_t(bins[row])]++)] = row;
    shadow.order[std::size_t(next[1][std::size_t(bins[row + 1])]++)] = row + 1;
  }
  if (even_rows < shadow.rows())
    shadow.order[std::size_t(next[0][std::size_t(bins[even_rows])]++)] = even_rows;
  block.clock.finish(Stage::aiming);
}

/// The same rays in sample order: to show that the order changes no result.
inline void keep_shadow_rays_in_order(SampleBlock& block) {
  ShadowRays& shadow = block.shadow;
  shadow.count = 0;
  for (int k = 0; k < shadow.samples; ++k)
    for (int row = shadow.row(k, 0); row < shadow.row(k, block.path.count); ++row)
      if (shadow.is_needed[row]) shadow.order[std::size_t(shadow.count++)] = row;
  block.clock.finish(Stage::aiming);
}

}  // namespace etendue

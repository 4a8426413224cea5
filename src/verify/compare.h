// Do two images of one scene agree: over the whole film, by material, by block and by pixel.
#pragma once

#include "verify/moment_image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// What an image is compared by.
struct ComparedImage {
  MomentImage image;
  /// What one more sample that finds light may add to a pixel, of samples that seldom do. 0 of others, whose
  /// own samples tell.
  double unseen_step = 0;
  MeanMoments whole{};                   ///< Sum over all pixels.
  std::vector<MeanMoments> materials{};  ///< Sums over the pixels that show each.
  std::vector<MeanMoments> blocks{};
  std::vector<double> block_steps{};  ///< Of each block: MeanMoments::step of it, those around, and all.
};

/// \param material_of_pixel that is seen through its middle, -1 where none is \param materials how many
ComparedImage compared_image(MomentImage image, std::span<const std::int32_t> material_of_pixel,
                             int materials, double unseen_step = 0);

void set_unseen_step(ComparedImage& image, double step);

/// Parts of the film that are tested.
struct Region {
  enum class Kind { whole, material, block, pixel } kind = Kind::whole;
  int x = 0, y = 0;           ///< Of a block's first pixel, or of a pixel.
  std::int32_t material = 0;  ///< Of Kind::material.
};

/// A region, how far apart two images are there.
struct Difference {
  Region region{};
  MeanTest test{};     ///< Of a - b.
  double p_value = 1;  ///< Of all tests of the pair together.
};

struct Comparison {
  double p_value = 1;      ///< Small where the images differ anywhere.
  Difference strongest{};  ///< What it comes from.
  Difference worst_block{};
  double ratio = 1, ratio_low = 1, ratio_high = 1;  ///< Of the mean of a to that of b; 95 % interval.
  double smallest_difference = 0;  ///< Of the whole image's mean, relative: found with probability 0.9.

  /// Whether differences of the mean that matter would have been found at all.
  bool can_tell() const { return smallest_difference <= 0.25; }
};

/// Tests all regions; each of the four kinds has a quarter of the level, and within it Bonferroni's share.
/// \param level at which the pair is tested, for `smallest_difference`; p-values do not depend on it but that
///   those above it may be rounded up to 1
Comparison compare(const ComparedImage& a, const ComparedImage& b, double level);

/// a - b in standard errors, of each block.
std::vector<double> block_differences(const ComparedImage& a, const ComparedImage& b);
/// Of each pixel.
std::vector<double> pixel_differences(const ComparedImage& a, const ComparedImage& b);

}  // namespace etendue

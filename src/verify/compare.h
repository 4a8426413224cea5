// Do two images of one scene agree: over the whole film, by material, by block and by pixel.
#pragma once

#include "verify/film_cells.h"
#include "verify/moment_image.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// The least that one more event must be thought to add to a pixel, of those that are too rare for what has
/// been found there to tell: a ray meets a small light, a light sample falls into a lobe or on the sliver of
/// a light that is not below the horizon.
struct LeastSteps {
  double of_lobes = 0, of_others = 0;  ///< In cells that may have rare hits of a lobe; in the others.

  double at(bool has_rare_hits) const { return has_rare_hits ? of_lobes : of_others; }
  double most() const { return std::max(of_lobes, of_others); }
};

/// What an image is compared by.
struct ComparedImage {
  MomentImage image;
  MeanMoments whole{};                   ///< Sum over all pixels.
  std::vector<MeanMoments> materials{};  ///< Sums over the cells of each that are tested with it.
  std::vector<MeanMoments> blocks{}, cells{};
  LeastSteps steps{};
  std::vector<double> block_steps{}, cell_steps{};  ///< Least steps there.
};

ComparedImage compared_image(MomentImage image, const FilmCells& film);

/// The steps that an image has on each kind of surface, wherever it is: where a highlight has been missed,
/// what else has been found there has small steps.
LeastSteps steps_seen(const ComparedImage& image, const FilmCells& film);
/// At least these.
void raise_steps(ComparedImage& image, const FilmCells& film, const LeastSteps& least);

/// Parts of the film that are tested.
struct Region {
  enum class Kind { whole, material, block, pixel } kind = Kind::whole;
  int x = 0, y = 0;           ///< Of a block's first pixel, or of a pixel.
  std::int32_t material = 0;  ///< Of Kind::material.
  /// Its cells count by how well they are known; of the whole image those without rare hits, if there are
  /// any.
  bool is_weighted = false;
};

/// A region, how far apart two images are there.
struct Difference {
  Region region{};
  MeanTest test{};     ///< Of a - b.
  double p_value = 1;  ///< Of all tests of the pair together.
  double ratio = 1;    ///< Of a to b.
};

struct Comparison {
  double p_value = 1;      ///< Small where the images differ anywhere.
  Difference strongest{};  ///< What it comes from.
  Difference worst_block{};
  double ratio = 1, ratio_low = 1, ratio_high = 1;  ///< Of the mean of a to that of b; 95 % interval.
  /// Relative, found with probability 0.9: of the whole image's mean, or the same factor in all pixels
  /// without rare hits, whichever is less.
  double smallest_difference = 0;

  /// Whether differences that matter would have been found at all.
  bool can_tell() const { return smallest_difference <= 0.25; }
};

/// Tests all regions; each of the four kinds has a quarter of the level, and within it Bonferroni's share.
/// \param means, weights of the cells, from other samples than those of a and b; where a mean is 0, so is
/// the weight
/// \param level at which the pair is tested, for `smallest_difference`; p-values do not depend on it but that
///   those above it may be rounded up to 1
Comparison compare(const ComparedImage& a, const ComparedImage& b, const FilmCells& film,
                   std::span<const double> means, std::span<const double> weights, double level);

/// a - b in standard errors, of each block.
std::vector<double> block_differences(const ComparedImage& a, const ComparedImage& b);
/// Of each pixel.
std::vector<double> pixel_differences(const ComparedImage& a, const ComparedImage& b);

}  // namespace etendue

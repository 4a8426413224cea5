// An image with what is known of how far each pixel may be off: what estimators are compared by.
#pragma once

#include "film/pixel_rectangle.h"
#include "render/render.h"
#include "stats/mean_moments.h"

#include <vector>

namespace etendue {

/// Luminances with their moments, rows from the top. Pixels are independent of each other.
struct MomentImage {
  int width = 0, height = 0;
  std::vector<MeanMoments> pixels;
  int replicates = 16;  ///< That the moments come from; of another renderer's image taken to be so many.

  const MeanMoments& at(int x, int y) const {
    return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
  /// Sum over pixels.
  MeanMoments sum_over(const PixelRectangle& rectangle) const;
};

/// Of a complete render whose replicates are independent, and whose luminances were kept.
MomentImage moment_image(const RenderResult& rendered);

/// The film in squares of this many pixels to a side, smaller at its right and lower edges.
inline constexpr int block_side = 16;
inline int blocks_along(int pixels) { return (pixels + block_side - 1) / block_side; }

/// Sums over blocks, rows from the top.
std::vector<MeanMoments> block_sums(const MomentImage& image);

}  // namespace etendue

// What a pixel remembers: count, mean and M2 over the means of its replicates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/color.h"

namespace etendue {

/// Statistics over replicate means, per colour channel (radiance, W/(m^2 sr)).
struct PixelStatistics {
  std::int64_t count = 0;  ///< Replicates; 0: not rendered.
  Color<double> mean{0, 0, 0};
  Color<double> m2{0, 0, 0};  ///< Sum of squared deviations from the mean.
};

/// The union of two disjoint sets of replicates (Chan, Golub, LeVeque 1979).
PixelStatistics combine(const PixelStatistics& a, const PixelStatistics& b);

/// Replicates `first`, `first + 1` ... with the given means, combined pairwise over aligned power-of-two blocks of
/// replicate indices, so that a merge of aligned shards gives the bits of one run.
PixelStatistics combine_replicates(std::span<const Color<double>> means, std::uint64_t first);

/// Standard error of the mean per channel; NaN where count < 2 (it is then unknown, not zero).
Color<double> standard_error(const PixelStatistics& pixel);

class Film {
 public:
  Film(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  PixelStatistics& at(int x, int y) { return pixels_[std::size_t(y) * width_ + x]; }
  const PixelStatistics& at(int x, int y) const { return pixels_[std::size_t(y) * width_ + x]; }
  Color<double> mean() const;  ///< Over all rendered pixels.

 private:
  int width_, height_;
  std::vector<PixelStatistics> pixels_;
};

}  // namespace etendue

// What a pixel remembers: count, mean, M2 and M3 over the means of its replicates.
#pragma once

#include "base/color.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Statistics over replicate means, per colour channel (radiance, W/(m^2 sr)). A replicate whose mean is NaN
/// shows as NaN: who renders decides what enters, the film hides nothing.
struct PixelStatistics {
  std::int64_t count = 0;  ///< Replicates; 0: not rendered.
  Color<double> mean{0, 0, 0};
  Color<double> m2{0, 0, 0};  ///< Sum of squared deviations from the mean.
  Color<double> m3{0, 0, 0};  ///< Sum of cubed deviations from the mean.

  friend bool operator==(const PixelStatistics&, const PixelStatistics&) = default;
};

/// The union of two disjoint sets of replicates, `a` holding the lower indices.
PixelStatistics combine(const PixelStatistics& a, const PixelStatistics& b);

/// Where the sum over replicates [first, last) is cut in two, last - first >= 2: at the index between them
/// that is a multiple of the largest power of two.
std::uint64_t replicate_split(std::uint64_t first, std::uint64_t last);

/// Replicates `first`, `first + 1` ... with the given means, combined pairwise over aligned power-of-two
/// blocks of replicate indices: the sum over a range is `combine` of the sums over its two parts at
/// replicate_split, and so on down to single replicates. So combining the shards [first, m) and [m, last)
/// gives the bits of one run exactly where m = replicate_split(first, last), as it is for neighbouring blocks
/// of one power of two: [0,4) and [4,8). Other cuts, [0,3) and [3,8) say, give the same sum but for rounding.
/// No means: count 0.
PixelStatistics combine_replicates(std::span<const Color<double>> means, std::uint64_t first);

/// Standard error of the mean per channel; NaN where count < 2 (it is then unknown, not zero).
Color<double> standard_error(const PixelStatistics& pixel);

/// Throws InputError unless both are positive.
void check_film_size(int width, int height);

/// The pixels of an image, rows from the top; all of them not rendered at first.
class Film {
 public:
  Film(int width, int height);  ///< Throws InputError unless both are positive.
  int width() const { return width_; }
  int height() const { return height_; }
  PixelStatistics& at(int x, int y) { return pixels_[std::size_t(y) * width_ + x]; }
  const PixelStatistics& at(int x, int y) const { return pixels_[std::size_t(y) * width_ + x]; }
  Color<double> mean() const;  ///< Mean of the means of all rendered pixels; NaN where none is.

 private:
  int width_, height_;
  std::vector<PixelStatistics> pixels_;
};

}  // namespace etendue

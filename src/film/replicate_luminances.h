// The luminance of each replicate of each pixel, kept where memory allows: what pixels are compared by.
#pragma once

#include "base/color.h"
#include "stats/running.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Replicates 0 to `replicates` - 1 of an image's pixels, rows from the top, as floats.
class ReplicateLuminances {
 public:
  /// Where so many replicates need more, none is kept. Enough for 3840 x 2160 pixels of 16 replicates.
  static constexpr std::size_t most_bytes = std::size_t(512) << 20;

  ReplicateLuminances() = default;  ///< Keeps none.
  ReplicateLuminances(int width, int height, int replicates);
  /// For the replicates before this one; those that there are stay. How many a render has planned does not
  /// matter, so that one that is interrupted keeps what one of fewer replicates does.
  void make_room(int replicates);

  bool is_kept() const { return is_kept_; }
  /// The means of the replicates from `first` on of a pixel. Threads may add different pixels at once.
  void add(int x, int y, std::int64_t first, std::span<const Color<double>> means);
  /// Of the first `replicates` of a pixel; nothing where none are kept.
  std::span<const float> at(int x, int y, std::int64_t replicates) const {
    if (!is_kept()) return {};
    return std::span(values_).subspan(offset(x, y), std::size_t(replicates));
  }

 private:
  std::size_t offset(int x, int y) const {
    return (std::size_t(y) * std::size_t(width_) + std::size_t(x)) * std::size_t(replicates_);
  }
  int width_ = 0, height_ = 0, replicates_ = 0;  ///< Room for so many.
  bool is_kept_ = false;
  std::vector<float> values_;
};

/// Count, mean and m2 of a pixel's; m3 is 0.
RunningStatistics statistics_of(std::span<const float> luminances);

}  // namespace etendue

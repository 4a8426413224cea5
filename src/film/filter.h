// Pixel filters, importance-sampled: a sample belongs to one pixel and lies where the filter puts it.
#pragma once

#include <string_view>
#include <vector>

#include "base/simd_math.h"
#include "base/vec.h"
#include "scenefile/parameters.h"

namespace etendue {

const std::vector<Plugin>& filter_plugins();

/// A separable, non-negative filter as the inverse of its cumulative distribution along one axis, tabulated and
/// interpolated linearly. Sampling it gives every sample weight 1, so the pixel is the plain mean of its samples
/// (Ernst, Stamminger and Greiner 2006, "Filter importance sampling").
class PixelFilter {
 public:
  /// `box` (radius 0.5 px unless given).
  static PixelFilter box(double radius_px = 0.5);
  static PixelFilter tent(double radius_px = 1);
  /// exp(-x^2 / (2 stddev^2)) minus its value at the radius, as in the Nori family.
  static PixelFilter gaussian(double radius_px = 2, double stddev_px = 0.5);

  /// Offset from the pixel's centre, in pixels, for u in [0, 1).
  template <class F>
  F sample_offset_px(const F& u) const {
    const F scaled = u * F(float(intervals));
    const Int<F> cell = to_int(scaled);
    const F from = gather(offset_px_.data(), cell);
    const F to = gather(offset_px_.data() + 1, cell);
    return from + (to - from) * (scaled - to_float(cell));
  }

  double radius_px() const { return offset_px_.back(); }

 private:
  static constexpr int intervals = 1024;
  /// `cumulative(x)` is proportional to the integral of the filter from -radius to x.
  template <class Cumulative>
  PixelFilter(double radius_px, const Cumulative& cumulative);
  std::vector<float> offset_px_;  ///< intervals + 1 quantiles.
};

/// Throws InputError for an unknown filter (with the known ones) or a parameter out of range.
PixelFilter make_filter(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

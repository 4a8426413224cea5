// Pixel filters, importance-sampled: a sample belongs to one pixel and lies where the filter puts it.
#pragma once

#include "base/simd_math.h"
#include "base/vec.h"
#include "scenefile/parameters.h"

#include <string_view>
#include <vector>

namespace etendue {

const std::vector<Plugin>& filter_plugins();

/// A separable, symmetric, non-negative filter as the inverse of its cumulative distribution along one axis,
/// tabulated and interpolated linearly. Sampling it gives every sample weight 1, so the pixel is the plain
/// mean of its samples (Ernst, Stamminger and Greiner 2006, "Filter importance sampling").
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
    if (is_box_) return (F(2) * u - F(1)) * F(-offset_px_.front());
    const auto is_left = u < F(0.5f);
    const F tail = select(is_left, u, F(1) - u);
    const F scaled = sqrt(tail + tail) * F(float(intervals));
    const Int<F> cell = to_int(scaled);
    const F from = gather(offset_px_.data(), cell);
    const F to = gather(offset_px_.data() + 1, cell);
    const F offset = from + (to - from) * (scaled - to_float(cell));
    return select(is_left, offset, -offset);
  }

  double radius_px() const { return -offset_px_.front(); }

 private:
  static constexpr int intervals = 1024;
  /// `cumulative(x)` is proportional to the integral of the filter from -radius to x.
  template <class Cumulative>
  PixelFilter(double radius_px, const Cumulative& cumulative);
  /// Quantiles of the left half, -radius to 0, at t = sqrt(2 u) = i / intervals: evenly spaced in t, they
  /// stand close enough in the tails, where filters end in a slope. One more 0 follows, for the upper
  /// neighbour of t = 1.
  std::vector<float> offset_px_;
  bool is_box_ = false;  ///< The inverse is a line: no table is needed.
};

/// Throws InputError for an unknown filter (with the known ones) or a parameter out of range.
PixelFilter make_filter(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

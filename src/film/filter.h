// Pixel filters, importance-sampled: a sample belongs to one pixel and lies where the filter puts it.
#pragma once

#include "base/gather.h"
#include "base/simd_math.h"
#include "base/vec.h"
#include "scenefile/parameters.h"

#include <string_view>
#include <vector>

namespace etendue {

const std::vector<Plugin>& filter_plugins();

/// A separable, symmetric filter f as the inverse of the cumulative distribution of |f| along one axis,
/// tabulated and interpolated linearly. Where f has no negative lobes every sample has weight 1, and the
/// pixel is the plain mean of its samples (Ernst, Stamminger and Greiner 2006, "Filter importance sampling").
/// Elsewhere a sample's radiance is multiplied by `sample_weight`; its expectation is then the integral of
/// f L over that of f, without bias.
class PixelFilter {
 public:
  /// `box` (radius 0.5 px unless given).
  static PixelFilter box(double radius_px = 0.5);
  static PixelFilter tent(double radius_px = 1);
  /// exp(-x^2 / (2 stddev^2)) minus its value at the radius, as in the Nori family.
  static PixelFilter gaussian(double radius_px = 2, double stddev_px = 0.5);
  /// The piecewise cubic of Mitchell and Netravali 1988, "Reconstruction filters in computer graphics",
  /// eq. 8, stretched so that it ends at the radius; b and c in [0, 1]. For c > 0 its outer lobes are
  /// negative.
  static PixelFilter mitchell(double radius_px = 2, double b = 1.0 / 3, double c = 1.0 / 3);

  /// Offset from the pixel's centre, in pixels, for u in [0, 1).
  template <class F>
  F sample_offset_px(const F& u) const {
    if (is_box_) return (F(2) * u - F(1)) * F(-offset_px_.front());
    const auto is_left = u < F(0.5f);
    const F tail = select(is_left, u, F(1) - u);
    F offset;
    if (is_signed()) {
      const auto is_outer = tail < F(negative_tail_);
      const F share = select(is_outer, tail * F(1 / negative_tail_),
                             (tail - F(negative_tail_)) * F(1 / (0.5f - negative_tail_)));
      offset = quantile_px(share, select(is_outer, Int<F>(0), Int<F>(intervals + 2)));
    } else {
      offset = quantile_px(tail + tail, Int<F>(0));
    }
    return select(is_left, offset, -offset);
  }

  /// Whether f has negative lobes; otherwise all weights are 1.
  bool is_signed() const { return negative_tail_ > 0; }

  /// What the radiance of the sample at the offsets of u_x and u_y is multiplied by: the sign of f(x) f(y)
  /// times (integral of |f| over integral of f)^2.
  template <class F>
  F sample_weight(const F& u_x, const F& u_y) const {
    return sign(u_x) * sign(u_y) * F(weight_);
  }

  double radius_px() const { return -offset_px_.front(); }

 private:
  static constexpr int intervals = 1024;
  PixelFilter() = default;
  /// \param cumulative(x) is proportional to the integral of the filter from -radius to x, for x up to 0.
  template <class Cumulative>
  PixelFilter(double radius_px, const Cumulative& cumulative);

  /// Appends to the table, see there.
  template <class Cumulative>
  void add_quantiles(double from_px, double to_px, const Cumulative& cumulative);
  /// \param share of the mass that the table which begins at `first` stands for
  template <class F>
  F quantile_px(const F& share, const Int<F>& first) const {
    const F scaled = sqrt(share) * F(float(intervals));
    const Int<F> within = to_int(scaled), cell = first + within;
    const F from = gather(offset_px_.data(), cell);
    const F to = gather(offset_px_.data() + 1, cell);
    return from + (to - from) * (scaled - to_float(within));
  }
  template <class F>
  F sign(const F& u) const {
    return select(min(u, F(1) - u) < F(negative_tail_), F(-1), F(1));
  }

  /// Quantiles of the left half, -radius to 0, at t = sqrt(share of its mass) = i / intervals: evenly spaced
  /// in t, they stand close enough in the tails, where filters end in a slope. The last one stands twice, for
  /// the upper neighbour of t = 1. A signed filter has two such tables: of its outer, negative lobe and of
  /// the inner, positive one; what sign a sample has is thus exact.
  std::vector<float> offset_px_;
  float negative_tail_ = 0;  ///< The share of the left, negative lobe in the mass of |f|.
  float weight_ = 1;
  bool is_box_ = false;  ///< The inverse is a line: no table is needed.
};

/// Throws InputError for an unknown filter (with the known ones) or a parameter out of range.
PixelFilter make_filter(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

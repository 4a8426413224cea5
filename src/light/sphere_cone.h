// The cone of directions from a receiver to a sphere, and where they meet it.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"

namespace etendue {

template <class F>
struct SphereCone {
  Vec3<F> center;                   ///< World, m.
  Vec3<F> to_center;                ///< Unit.
  F radius;                         ///< m
  F sin_max_sq, one_minus_cos_max;  ///< Of half its opening.
  Mask<F> is_outside;               ///< The receiver; elsewhere there is no cone.

  SphereCone(const Vec3<F>& center_of_sphere, const F& radius_of_sphere, const Vec3<F>& receiver)
      : center(center_of_sphere), radius(radius_of_sphere) {
    const Vec3<F> offset = center - receiver;
    const F distance_sq = length_sq(offset);
    is_outside = distance_sq > radius * radius;
    to_center = offset * (F(1) / sqrt(select(is_outside, distance_sq, F(1))));
    sin_max_sq = select(is_outside, radius * radius / distance_sq, F(1));
    // 1 - sqrt(1 - s) without cancellation for small s.
    one_minus_cos_max = sin_max_sq / (F(1) + sqrt(max(F(1) - sin_max_sq, F(0))));
  }

  /// The sine and cosine, at the centre, of the angle between the receiver and the point that a direction
  /// meets first, from which the point follows without cancellation (Pharr, Jakob and Humphreys, Physically
  /// Based Rendering, 4th ed., section 6.2.4).
  Vec2<F> at_center(const F& sin_theta_sq, const F& cos_theta) const {
    const F sin_ratio_sq = min(sin_theta_sq / sin_max_sq, F(1));
    const F sin_max = sqrt(sin_max_sq);
    const F cosine = sin_ratio_sq * sin_max + cos_theta * sqrt(F(1) - sin_ratio_sq);
    // sin(asin(ratio) - theta) as a quotient: from the cosine, points below a receiver that all but touches
    // the sphere would lie on a few rings.
    const F sine = sqrt(sin_ratio_sq) * (F(1) - sin_max_sq) /
                   (cos_theta + sqrt(max(sin_max_sq - sin_theta_sq, F(0x1p-60f))));
    return {sine, cosine};
  }
};

}  // namespace etendue

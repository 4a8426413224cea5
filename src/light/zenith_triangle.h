// The spherical triangle between the zenith and a side: its projected solid angle, and directions in it with
// density in proportion to the cosine.
#pragma once

#include "base/angles.h"
#include "base/vec.h"

namespace etendue {

/// A side as it stands below the zenith, which is z.
template <class F>
struct ZenithTriangle {
  Vec3<F> place, along;            ///< Where the side begins, from the receiver; the side, from there.
  F angle;                         ///< Of the side.
  F signed_projected_solid_angle;  ///< sr; < 0 where the zenith is on the other side.

  /// Half the angle times the cosine of the side's plane (Lambert 1760).
  ZenithTriangle(const Vec3<F>& begin, const Vec3<F>& to_end) : place(begin), along(to_end) {
    const Vec3<F> across = cross(along, place);
    const F size = max(length(across), F(1e-30f));
    angle = half_turn_angle(size, length_sq(place) + dot(place, along));
    signed_projected_solid_angle = F(0.5f) * across.z / size * angle;
  }

  /// A direction, unit. \param u the share of the angle, and of the projected area from the zenith
  Vec3<F> sample(const Vec2<F>& u) const {
    const Vec3<F> a = normalize(place), across = along - a * dot(a, along);
    F sine, cosine;
    sincos_half_turn(u.x * angle, sine, cosine);
    const Vec3<F> edge = normalize(a * cosine + across * (sine / max(length(across), F(1e-30f))));
    const F radius = sqrt(u.y);
    return {edge.x * radius, edge.y * radius, sqrt(max(F(1) - u.y * (F(1) - edge.z * edge.z), F(0)))};
  }
};

}  // namespace etendue

// The spherical triangle between the zenith and a side: its projected solid angle, and directions in it with
// density in proportion to the cosine.
#pragma once

#include "base/angles.h"
#include "base/vec.h"

namespace etendue {

/// Half the angle of the side times the cosine of its plane (Lambert 1760), in sr; < 0 where the side runs to
/// the left as the zenith sees it from below. \param place where the side begins, with the zenith as z \param
/// along the side, from there
template <class F>
F zenith_triangle_projected_solid_angle(const Vec3<F>& place, const Vec3<F>& along) {
  const Vec3<F> across = cross(along, place);
  const F size = max(length(across), F(1e-30f));
  return F(0.5f) * across.z / size * half_turn_angle(size, length_sq(place) + dot(place, along));
}

/// A direction, unit. \param u the share of the side's angle, the share of the projected area from the zenith
template <class F>
Vec3<F> sample_zenith_triangle(const Vec3<F>& place, const Vec3<F>& along, const Vec2<F>& u) {
  const F angle = half_turn_angle(length(cross(along, place)), length_sq(place) + dot(place, along));
  const Vec3<F> a = normalize(place), across = along - a * dot(a, along);
  F sine, cosine;
  sincos_half_turn(u.x * angle, sine, cosine);
  const Vec3<F> edge = a * cosine + across * (sine / max(length(across), F(1e-30f)));
  const F radius = sqrt(u.y);
  return {edge.x * radius, edge.y * radius, sqrt(max(F(1) - u.y * (F(1) - edge.z * edge.z), F(0)))};
}

}  // namespace etendue

// How far off a surface rays start, and shadow segments end: what rounding cannot tell from the surface.
#pragma once

#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

/// Eight rounding errors. Of rays that start at 4 times 2^-24 of what clearance() sums, none was seen to meet
/// its own triangle again, or a neighbour in its plane, but for slivers at grazing angles.
inline constexpr float rounding_bound = 0x1p-21f;

/// The height (m) above a point of a surface at which rays are clear of it: a bound of the errors that the
/// point's computing leaves across the surface, and the ray caster's later. It does not depend on where the
/// origin is along the surface: nothing is lost above a floor through the origin, however wide.
/// \param ng of the surface, unit
/// \param terms per axis, the sum of the absolute values of what was added up to make the point (m)
/// \param longest_edge of the triangles there (m); 0 of shapes that are no triangles
template <class F>
F clearance(const Vec3<F>& ng, const Vec3<F>& terms, const F& longest_edge) {
  const F x = abs(ng.x), y = abs(ng.y), z = abs(ng.z);
  // A triangle square to an axis keeps its place along it exactly; others by the rounding of their edges.
  const F tilt = x + y + z - max(max(x, y), z);
  return F(rounding_bound) * (x * terms.x + y * terms.y + z * terms.z + tilt * longest_edge);
}

/// The absolute value of each component.
template <class F>
Vec3<F> abs_each(const Vec3<F>& v) {
  return {abs(v.x), abs(v.y), abs(v.z)};
}

}  // namespace etendue

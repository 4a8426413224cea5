// A linearly transformed cosine: a density of directions with the shape of a glossy lobe.
#pragma once

#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

/// Heitz, Dupuy, Hill and Neubelt 2016, "Real-time polygonal-light shading with linearly transformed
/// cosines", eq. 1: directions M t, made unit, where t has the density cos(theta) / pi about z, and M a
/// positive determinant. What a polygon holds of the lobe is what the polygon seen through M^-1 holds of the
/// cosine.
template <class F>
struct LinearlyTransformedCosine {
  Vec3<F> column_x, column_y, column_z;  ///< Of M; world.
  Vec3<F> row_x, row_y, row_z;           ///< Of M^-1.
  F inverse_determinant;                 ///< Of M.

  /// M^-1 v.
  Vec3<F> cosine_from_lobe(const Vec3<F>& v) const { return {dot(row_x, v), dot(row_y, v), dot(row_z, v)}; }
  /// M t.
  Vec3<F> lobe_from_cosine(const Vec3<F>& t) const {
    return column_x * t.x + column_y * t.y + column_z * t.z;
  }
  /// pi times the density (1/sr) of a unit direction.
  F density_times_pi(const Vec3<F>& wi) const {
    const Vec3<F> t = cosine_from_lobe(wi);
    const F size_sq = length_sq(t);
    return max(t.z, F(0)) * inverse_determinant / (size_sq * size_sq);
  }
};

}  // namespace etendue

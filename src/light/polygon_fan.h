// A convex polygon as a receiver sees it: a fan of triangles around its first corner.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "geometry/convex_pieces.h"

#include <array>
#include <cstdint>

namespace etendue {

/// Lanes of polygons with different numbers of corners. Sides from the first corner and areas come from the
/// polygon alone, in double precision: far and thin polygons keep what the corners' differences would lose.
template <class F>
struct PolygonFan {
  Vec3<F> apex;                                 ///< The first corner, from the receiver (m).
  std::array<Vec3<F>, most_corners> from_apex;  ///< Of each corner, from the first (m).
  std::array<F, most_corners> twice_area;       ///< Of the triangle (0, k - 1, k), m^2; k from 2 on.
  Vec3<F> ng;                                   ///< Unit, of the side that shines at the receiver.
  /// Of the receiver above the polygon's plane (m), > 0 where a side that shines faces it; 0 where rounding
  /// cannot tell.
  F height;
  F area, spread;         ///< m^2; spread_of, by the diagonals from the first corner.
  Mask<F> is_turned;      ///< The receiver is behind a polygon that shines from there too.
  Int<F> corners, label;  ///< The label is the table's user's.
  int most;               ///< The greatest of `corners` among the lanes that ask.

  /// Of the farthest corner from the receiver (m).
  F farthest() const {
    F distance_sq = length_sq(apex);
    for (int k = 1; k < most; ++k)
      distance_sq = max(distance_sq,
                        select(less(Int<F>(k), corners), length_sq(apex + from_apex[std::size_t(k)]), F(0)));
    return sqrt(distance_sq);
  }

  /// To the polygon's plane along a direction (unit) that meets the polygon, m. Along the plane itself
  /// rounding must not put the place behind the receiver, nor beyond the polygon.
  F distance_along(const Vec3<F>& wi) const { return min(height / max(-dot(wi, ng), F(1e-30f)), farthest()); }
};

}  // namespace etendue

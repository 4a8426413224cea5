// Triangles of a mesh that lie in one plane, side by side -> convex polygons.
#pragma once

#include "base/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

inline constexpr int most_corners = 8;  ///< Of a convex polygon.

/// A mesh cut into flat convex polygons: each triangle lies in one of them, and each of them is its
/// triangles.
struct ConvexPieces {
  std::vector<Vec3f> corners;              ///< Of one polygon after the other, turning as its triangles do.
  std::vector<std::int32_t> first_corner;  ///< Of each polygon, and the end of the last; 3 to 8 corners each.
  std::vector<std::int32_t> piece;         ///< Of each triangle: the number of its polygon.

  std::int32_t count() const { return std::int32_t(first_corner.size()) - 1; }
};

/// Joins triangles that share a side, lie in one plane and make a convex polygon together; then these, and so
/// on, over long sides first: a greedy way (Hertel and Mehlhorn 1983) that does not find the fewest polygons.
/// Corners that rounding cannot tell from a straight side are left out. The area of a polygon is that of its
/// triangles to within 1e-6. Vertices are one where their positions are equal.
/// \param positions (m) \param indices three positions a triangle; may name only a part of `positions`
ConvexPieces convex_pieces(std::span<const Vec3f> positions, std::span<const std::int32_t> indices);

}  // namespace etendue

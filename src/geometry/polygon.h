// A polygon of a mesh file -> triangles between its corners.
#pragma once

#include "base/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

struct PolygonTriangles {
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< By number in the polygon, in its turn.
  bool is_simple = true;  ///< Else the polygon crosses itself, and the triangles are a fan.
  bool is_flat = true;    ///< Else a corner lies further from its mean plane than a tenth of its size.
};

/// Four corners or more. Where the fan of corner 0 is right, as for every convex polygon, it is that fan; of
/// a quad (0,1,2),(3,0,2), as in Nori, or else the other diagonal. Any other simple polygon is given its
/// constrained Delaunay triangulation in its mean plane. A polygon may touch itself: a hole is a loop that an
/// edge, walked there and back, joins to the outline. A quad has no mean plane: it counts as not simple
/// where both of its diagonals fold it by more than 90 degrees.
/// \param triangles overwritten; its memory is used again
void triangulate(std::span<const Vec3<double>> polygon, PolygonTriangles& triangles);

}  // namespace etendue

// A polygon in the plane -> triangles between its corners.
#pragma once

#include "base/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// The constrained Delaunay triangulation of a polygon that may touch itself in corners, and along edges
/// walked there and back. The triangles name their corners by number and turn as the polygon does.
/// \return false where the polygon crosses itself
extern "C" bool etendue_triangulate_in_plane(std::span<const etendue::Vec2<double>> polygon,
                                             std::vector<std::array<std::uint32_t, 3>>& triangles);

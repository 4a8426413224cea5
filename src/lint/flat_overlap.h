// Whether two flat pieces of surface lie in one place.
#pragma once

#include "geometry/geometry.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// A triangle, or a polygon within a disk; in double, as distances are those of rounding errors.
struct FlatPiece {
  std::vector<Vec3<double>> corners;  ///< Convex, in their turn about `ng`.
  Vec3<double> ng;                    ///< Unit.
  double rounding;  ///< So far may a point of it lie from where it was meant: rounded coordinates (m).
};

/// How far a point may be moved by rounding the coordinates of a shape whose largest is `largest`: two units
/// in their last place.
inline double rounding_of(double largest) { return 0x1p-22 * largest; }

FlatPiece triangle_piece(const Geometry& geometry, std::size_t triangle);
FlatPiece disk_piece(const Disk& disk);

struct Overlap {
  bool is_there = false;
  bool is_opposite = false;  ///< The fronts are on opposite sides.
  Vec3<double> middle{};     ///< World, m.
};

/// An overlap of positive area all of whose points are within rounding of both pieces.
Overlap overlap_of(const FlatPiece& a, const FlatPiece& b);

}  // namespace etendue

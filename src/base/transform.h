// Affine transforms, in double: they are made once from a scene's text and applied at load time.
#pragma once

#include "base/vec.h"

#include <array>

namespace etendue {

/// A 4x4 matrix acting on column vectors; rows first. `world_from_object * p` maps object to world.
struct Transform {
  std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

  friend Transform operator*(const Transform& a, const Transform& b);
  friend bool operator==(const Transform&, const Transform&) = default;
};

Transform translation(const Vec3<double>& offset);
Transform scaling(const Vec3<double>& factors);
/// Counter-clockwise seen from the tip of `axis` (any length but zero); angle in degrees.
Transform rotation(const Vec3<double>& axis, double angle_deg);
/// Nori's camera frame: columns left = up x direction, new up, direction, origin.
/// The result is singular (determinant 0) where target = origin or up is parallel to the direction (sine <
/// 1e-12).
Transform look_at(const Vec3<double>& origin, const Vec3<double>& target, const Vec3<double>& up);
/// The first two columns are 0 and the third is not: all that is left of a vector is its z, along one
/// direction.
bool is_projection_to_z(const Transform& t);

double determinant(const Transform& t);  ///< Of the upper left 3x3 block.
/// True where all entries are finite and the 3x3 block can be inverted in floating point, whatever its unit
/// of length.
bool is_invertible(const Transform& t);

Vec3<double> transform_point(const Transform& t, const Vec3<double>& p);
Vec3<double> transform_vector(const Transform& t, const Vec3<double>& v);
/// By the inverse transpose of the 3x3 block: what points outward still does, also under a mirror image
/// (which turns the winding of triangles over); not normalised. Needs is_invertible(t).
Vec3<double> transform_normal(const Transform& t, const Vec3<double>& n);

}  // namespace etendue

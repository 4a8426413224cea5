#include "lint/flat_overlap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

using Vec3d = Vec3<double>;

Vec3d unit(const Vec3d& v) { return v * (1 / std::sqrt(std::max(length_sq(v), 1e-300))); }

FlatPiece piece_of(std::vector<Vec3d> corners, const Vec3d& ng) {
  double largest = 0;
  for (const Vec3d& p : corners) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return {std::move(corners), ng, rounding_of(largest)};
}

/// The part of a convex polygon on the inner side of the plane through `from` with the normal `inward`.
std::vector<Vec3d> clipped(const std::vector<Vec3d>& polygon, const Vec3d& from, const Vec3d& inward) {
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double height_p = dot(p - from, inward), height_q = dot(q - from, inward);
    if (height_p >= 0) kept.push_back(p);
    if ((height_p >= 0) != (height_q >= 0)) kept.push_back(p + (q - p) * (height_p / (height_p - height_q)));
  }
  return kept;
}

}  // namespace

FlatPiece triangle_piece(const Geometry& geometry, std::size_t triangle) {
  const auto corner = [&](std::size_t k) {
    return widen(geometry.positions[std::size_t(geometry.indices[3 * triangle + k])]);
  };
  const Vec3d p = corner(0), q = corner(1), r = corner(2);
  return piece_of({p, q, r}, unit(cross(q - p, r - p)));
}

FlatPiece disk_piece(const Disk& disk) {
  constexpr int sides = 24;
  const Vec3d along_x = widen(disk.along_x), along_y = widen(disk.along_y), ng = widen(disk.ng);
  // In their turn about ng, which a mirror image leaves where it was.
  const double turn = dot(cross(along_x, along_y), ng) < 0 ? -1 : 1;
  std::vector<Vec3d> corners;
  for (int k = 0; k < sides; ++k) {
    const double angle = turn * 2 * std::numbers::pi * k / sides;
    corners.push_back(widen(disk.center) + along_x * std::cos(angle) + along_y * std::sin(angle));
  }
  return piece_of(std::move(corners), ng);
}

Overlap overlap_of(const FlatPiece& a, const FlatPiece& b) {
  const double cosine = dot(a.ng, b.ng);
  constexpr double nearly_parallel = 0.999;
  if (std::abs(cosine) < nearly_parallel) return {};
  const double rounding = std::max(a.rounding, b.rounding);
  std::vector<Vec3d> common = b.corners;
  for (std::size_t i = 0; i < a.corners.size() && common.size() >= 3; ++i) {
    const Vec3d &from = a.corners[i], along = a.corners[(i + 1) % a.corners.size()] - from;
    common = clipped(common, from, unit(cross(a.ng, along)));
  }
  if (common.size() < 3) return {};
  Vec3d twice_area{0, 0, 0}, sum{0, 0, 0};
  double circumference = 0;
  for (std::size_t i = 0; i < common.size(); ++i) {
    const Vec3d &p = common[i], q = common[(i + 1) % common.size()];
    if (std::abs(dot(p - a.corners[0], a.ng)) > rounding) return {};
    twice_area = twice_area + cross(p - common[0], q - common[0]);
    circumference += std::sqrt(length_sq(q - p));
    sum = sum + p;
  }
  // Neighbours share an edge, along which rounding may make a sliver.
  if (0.5 * std::sqrt(length_sq(twice_area)) <= 4 * rounding * circumference) return {};
  return {true, cosine < 0, sum * (1.0 / double(common.size()))};
}

}  // namespace etendue

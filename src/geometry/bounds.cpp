#include "geometry/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace etendue {

namespace {

/// Half the size of a disk's bounding box along each axis (m).
std::array<double, 3> half_extent(const Disk& disk) {
  const auto along = [](float x, float y) { return std::hypot(double(x), double(y)); };
  return {along(disk.along_x.x, disk.along_y.x), along(disk.along_x.y, disk.along_y.y),
          along(disk.along_x.z, disk.along_y.z)};
}

/// The box about `center`, rounded outwards, so that it never cuts the shape.
Box box_about(const Vec3f& center, const std::array<double, 3>& half) {
  const auto below = [](double c, double h) { return std::nextafter(float(c - h), -Box::infinity); };
  const auto above = [](double c, double h) { return std::nextafter(float(c + h), Box::infinity); };
  return {{below(center.x, half[0]), below(center.y, half[1]), below(center.z, half[2])},
          {above(center.x, half[0]), above(center.y, half[1]), above(center.z, half[2])}};
}

}  // namespace

Box box_of(const Disk& disk) { return box_about(disk.center, half_extent(disk)); }
Box box_of(const Sphere& sphere) {
  return box_about(sphere.center, {sphere.radius, sphere.radius, sphere.radius});
}

Box box_of(const Geometry& geometry, std::int32_t id) {
  const auto at = std::size_t(id);
  if (geometry.sphere[at] >= 0) return box_of(geometry.spheres[std::size_t(geometry.sphere[at])]);
  if (geometry.disk[at] >= 0) return box_of(geometry.disks[std::size_t(geometry.disk[at])]);
  Box box;
  const std::size_t begin = 3 * std::size_t(geometry.first_triangle[at]),
                    end = begin + 3 * std::size_t(geometry.triangles[at]);
  for (std::size_t k = begin; k < end; ++k) box.include(geometry.positions[std::size_t(geometry.indices[k])]);
  return box;
}

Sphere bounding_sphere(const Geometry& geometry) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  const auto include = [&](const Vec3f& p, const std::array<double, 3>& extent) {
    const std::array<double, 3> at{p.x, p.y, p.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis] - extent[axis]);
      high[axis] = std::max(high[axis], at[axis] + extent[axis]);
    }
  };
  // Behind the last vertex stands a spare one.
  for (std::size_t i = 0; i + 1 < geometry.positions.size(); ++i) include(geometry.positions[i], {0, 0, 0});
  for (const Sphere& s : geometry.spheres) include(s.center, {s.radius, s.radius, s.radius});
  for (const Disk& disk : geometry.disks) include(disk.center, half_extent(disk));
  if (low[0] > high[0]) return {{0, 0, 0}, 0};
  const auto middle = [&](std::size_t axis) { return float(0.5 * (low[axis] + high[axis])); };
  const Vec3f center{middle(0), middle(1), middle(2)};
  const std::array<double, 3> c{center.x, center.y, center.z};
  double radius_sq = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = std::max(high[axis] - c[axis], c[axis] - low[axis]);
    radius_sq += half * half;
  }
  return {center, std::nextafter(float(std::sqrt(radius_sq)), std::numeric_limits<float>::infinity())};
}

}  // namespace etendue

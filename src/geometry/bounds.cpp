#include "geometry/bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace etendue {

Sphere bounding_sphere(const Geometry& geometry) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  const auto include = [&](const Vec3f& p, double radius) {
    const std::array<double, 3> at{p.x, p.y, p.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis] - radius);
      high[axis] = std::max(high[axis], at[axis] + radius);
    }
  };
  // Behind the last vertex stands a spare one.
  for (std::size_t i = 0; i + 1 < geometry.positions.size(); ++i) include(geometry.positions[i], 0);
  for (const Sphere& sphere : geometry.spheres) include(sphere.center, double(sphere.radius));
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

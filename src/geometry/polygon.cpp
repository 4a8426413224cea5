#include "geometry/polygon.h"

#include "base/module.h"
#include "geometry/plane_polygon.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace etendue {
namespace {

using Polygon = std::span<const Vec3<double>>;
using TriangleCorners = std::vector<std::array<std::uint32_t, 3>>;

/// Of lengths: what a float does not tell from 0, as in MeshBuilder.
constexpr double rounding = 0x1p-21;

void triangulate_quad(Polygon p, PolygonTriangles& triangles) {
  const auto cos_fold = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return dot(cross(p[b] - p[a], p[c] - p[a]), cross(p[a] - p[d], p[c] - p[d]));
  };
  triangles.corners.assign({{0, 1, 2}, {3, 0, 2}});
  if (cos_fold(0, 1, 2, 3) >= 0) return;
  triangles.is_simple = cos_fold(1, 2, 3, 0) > 0;
  if (triangles.is_simple) triangles.corners.assign({{1, 2, 3}, {0, 1, 3}});
}

void make_fan(Polygon p, TriangleCorners& corners) {
  corners.clear();
  for (std::uint32_t k = 1; k + 1 < p.size(); ++k) corners.push_back({0, k, k + 1});
}

/// Whether all triangles of the fan turn as the polygon does and together go round corner 0 less than once.
bool is_fan_right(Polygon p, const Vec3<double>& normal) {
  const Vec3<double> first = p[1] - p[0];
  bool is_past_half = false;
  for (std::size_t k = 1; k + 1 < p.size(); ++k) {
    const Vec3<double> a = p[k] - p[0], b = p[k + 1] - p[0];
    const double longest_sq = std::max(length_sq(a), length_sq(b));
    if (k + 2 == p.size() && length_sq(b) == 0) continue;  // The first corner again, to close the outline.
    if (length_sq(a) == 0 || length_sq(b) == 0) return false;
    if (dot(cross(a, b), normal) < -rounding * longest_sq) return false;
    const double side = dot(cross(first, b), normal) / std::sqrt(length_sq(first) * length_sq(b));
    if (is_past_half && side > rounding) return false;
    is_past_half = is_past_half || side < -rounding;
  }
  return true;
}

bool is_flat(Polygon p, const Vec3<double>& normal) {
  Vec3<double> least = p[0], most = p[0];
  double lowest = 0, highest = 0;
  for (const Vec3<double>& corner : p) {
    least = {std::min(least.x, corner.x), std::min(least.y, corner.y), std::min(least.z, corner.z)};
    most = {std::max(most.x, corner.x), std::max(most.y, corner.y), std::max(most.z, corner.z)};
    const double height = dot(corner - p[0], normal);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return highest - lowest <= 0.2 * length(most - least);
}

/// Along the axis nearest to the normal the corners are dropped: so what coincides in the file does here.
std::vector<Vec2<double>> drop(Polygon p, const Vec3<double>& normal) {
  const Vec3<double> n{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  std::vector<Vec2<double>> dropped;
  for (const Vec3<double>& c : p)
    dropped.push_back(n.z >= n.x && n.z >= n.y ? Vec2<double>{c.x, c.y}
                      : n.x >= n.y             ? Vec2<double>{c.y, c.z}
                                               : Vec2<double>{c.z, c.x});
  return dropped;
}

/// GEOS, which few files need, takes longer to load than the rest of the program.
bool triangulate_in_plane(std::span<const Vec2<double>> polygon, TriangleCorners& corners) {
  static const auto function = reinterpret_cast<decltype(&etendue_triangulate_in_plane)>(
      module_entry("plane_polygon", "etendue_triangulate_in_plane"));
  return function(polygon, corners);
}

}  // namespace

void triangulate(Polygon polygon, PolygonTriangles& triangles) {
  triangles.is_simple = triangles.is_flat = true;
  if (polygon.size() == 4) return triangulate_quad(polygon, triangles);
  make_fan(polygon, triangles.corners);
  Vec3<double> sum{0, 0, 0};
  double longest_sq = 0;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Vec3<double> a = polygon[k] - polygon[0], b = polygon[k + 1] - polygon[0];
    sum = sum + cross(a, b);
    longest_sq = std::max({longest_sq, length_sq(a), length_sq(b)});
  }
  const double doubled_area = length(sum);
  if (!(doubled_area > rounding * longest_sq)) return;  // All on a line, or of a single point.
  const Vec3<double> normal = sum / doubled_area;
  triangles.is_flat = is_flat(polygon, normal);
  if (is_fan_right(polygon, normal)) return;
  triangles.is_simple = triangulate_in_plane(drop(polygon, normal), triangles.corners);
  if (!triangles.is_simple) make_fan(polygon, triangles.corners);
}

}  // namespace etendue

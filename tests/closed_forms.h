// Irradiance in closed form: what renders are held against.
#pragma once

#include "base/vec.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace etendue {

using Vec3d = Vec3<double>;

/// The part of a convex polygon above the plane through `point` with `normal` (Sutherland and Hodgman 1974).
inline std::vector<Vec3d> clip_to_horizon(const std::vector<Vec3d>& polygon, const Vec3d& point,
                                          const Vec3d& normal) {
  std::vector<Vec3d> above;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double height_a = dot(a - point, normal), height_b = dot(b - point, normal);
    if (height_a >= 0) above.push_back(a);
    if ((height_a > 0 && height_b < 0) || (height_a < 0 && height_b > 0))
      above.push_back(a + (b - a) * (height_a / (height_a - height_b)));
  }
  return above;
}

/// Irradiance (W/m^2) at `point` on a surface with unit `normal`, from a flat polygon of constant `radiance`
/// whose corners run counter-clockwise seen from its front; 0 behind it. Exact: J. H. Lambert, Photometria,
/// 1760; in this form Arvo 1995, "Analytic methods for simulated light transport", eq. 4.5: E = L/2 sum of
/// theta_i n . Gamma_i.
inline double polygon_irradiance(const std::vector<Vec3d>& polygon, double radiance, const Vec3d& point,
                                 const Vec3d& normal) {
  const Vec3d front = cross(polygon[1] - polygon[0], polygon[2] - polygon[0]);
  if (dot(point - polygon[0], front) <= 0) return 0;
  const std::vector<Vec3d> above = clip_to_horizon(polygon, point, normal);
  double sum = 0;
  for (std::size_t i = 0; i < above.size(); ++i) {
    const Vec3d a = normalize(above[i] - point), b = normalize(above[(i + 1) % above.size()] - point);
    const Vec3d across = cross(a, b);
    const double sine = length(across);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(normal, across) / sine;
  }
  return 0.5 * radiance * std::abs(sum);
}

/// Irradiance (W/m^2) from a sphere of constant `radiance` that lies wholly above the horizon of the
/// receiver: pi L (r / d)^2 cos theta, as from a disc that subtends the same cone. Throws
/// std::invalid_argument elsewhere.
inline double sphere_irradiance(const Vec3d& center, double radius, double radiance, const Vec3d& point,
                                const Vec3d& normal) {
  const Vec3d offset = center - point;
  const double distance = length(offset), height = dot(offset, normal);
  if (height < radius) throw std::invalid_argument("sphere_irradiance: the sphere reaches below the horizon");
  return std::numbers::pi * radiance * (radius / distance) * (radius / distance) * (height / distance);
}

}  // namespace etendue

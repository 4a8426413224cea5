#include "light/light_bounds.h"

#include <algorithm>

namespace etendue {

LightBounds bounds_of(const Box& box, std::span<const Vec3<double>> across) {
  Vec3<double> sum{0, 0, 0};
  for (const Vec3<double>& a : across) sum = sum + a;
  const double size = length(sum);
  if (!(size > 0)) return {box, {0, 0, 1}, -1, 0};
  const Vec3<double> axis = sum * (1 / size);
  double cos_normals = 1;
  for (const Vec3<double>& a : across) cos_normals = std::min(cos_normals, dot(a, axis) / length(a));
  // Rounded to a wider cone.
  return {box, {float(axis.x), float(axis.y), float(axis.z)}, std::max(float(cos_normals) - 1e-6f, -1.0f), 0};
}

}  // namespace etendue

// What a receiver sees of a convex polygon, in extended precision.
#pragma once

#include "base/vec.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

using Vec3l = Vec3<long double>;

inline Vec3l extended(const Vec3f& v) { return {v.x, v.y, v.z}; }

/// A polygon's corners from a receiver, turning to the right as it sees them; extended precision.
using Outline = std::vector<Vec3l>;

/// The part where dot(p, normal) >= least.
inline Outline clipped(const Outline& outline, const Vec3l& normal, long double least = 0) {
  Outline part;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec3l a = outline[k], b = outline[(k + 1) % outline.size()];
    const long double above_a = dot(a, normal) - least, above_b = dot(b, normal) - least;
    if (above_a >= 0) part.push_back(a);
    if ((above_a < 0) != (above_b < 0)) part.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  return part;
}

/// sr; Van Oosterom and Strackee 1983.
inline long double solid_angle(const Outline& outline) {
  long double sum = 0;
  for (std::size_t k = 2; k < outline.size(); ++k) {
    const Vec3l &a = outline[0], &b = outline[k - 1], &c = outline[k];
    const long double la = length(a), lb = length(b), lc = length(c);
    sum += 2 * std::atan2(-dot(a, cross(b - a, c - a)),
                          la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la);
  }
  return sum;
}

/// sr, of what is above the horizon; Lambert 1760.
inline long double projected_solid_angle(const Outline& outline, const Vec3l& ns) {
  const Outline part = clipped(outline, ns);
  long double sum = 0;
  for (std::size_t k = 0; k < part.size(); ++k) {
    const Vec3l &a = part[k], &b = part[(k + 1) % part.size()];
    const Vec3l across = cross(b - a, a);
    const long double size = length(across);
    if (size > 0) sum += dot(across, ns) / size * std::atan2(size, dot(a, b)) / 2;
  }
  return sum;
}

}  // namespace etendue

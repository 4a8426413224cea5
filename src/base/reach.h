// How far from the origin things may be.
#pragma once

#include "base/vec.h"

#include <cmath>

namespace etendue {

/// Whether p (m) is a place that can be computed with: products of distances fit a float, and the ray caster
/// takes rays from there. False for NaN.
template <class T>
bool is_within_reach(const Vec3<T>& p) {
  constexpr double farthest = 1e15;
  return std::abs(double(p.x)) <= farthest && std::abs(double(p.y)) <= farthest &&
         std::abs(double(p.z)) <= farthest;
}

}  // namespace etendue

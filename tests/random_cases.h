// What generators of random cases in extended precision have in common.
#pragma once

#include "polygon_outline.h"

#include <cmath>
#include <numbers>
#include <random>

namespace etendue {

class RandomCases {
 public:
  explicit RandomCases(unsigned seed) : random_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }

 protected:
  Vec3l direction() {
    const double z = 2 * unit() - 1, across = std::sqrt(1 - z * z), turn = 2 * std::numbers::pi * unit();
    return {across * std::cos(turn), across * std::sin(turn), z};
  }
  static Vec3f rounded(const Vec3l& v) { return {float(v.x), float(v.y), float(v.z)}; }

  std::mt19937_64 random_;
};

}  // namespace etendue

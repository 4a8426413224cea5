// A box along the axes.
#pragma once

#include "base/vec.h"

#include <algorithm>
#include <limits>

namespace etendue {

/// World, m; empty at first.
struct Box {
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  Vec3f low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};

  void include(const Vec3f& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
};

}  // namespace etendue

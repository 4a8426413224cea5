// A checkerboard of two colours.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "scenefile/parameters.h"

namespace etendue {

/// `even` where floor(u / scale - delta) and the same of v have an even sum, else `odd`, as in the forks of
/// ETH and Tuebingen: `scale` is the size of a square in uv, `delta` a shift in squares.
struct Checkerboard {
  Colorf even{0, 0, 0}, odd{1, 1, 1};
  Vec2f delta{0, 0}, scale{1, 1};

  template <class F>
  Color<F> at(const Vec2<F>& uv, const Mask<F>& /*lanes*/) const {
    const F sum = floor(uv.x / F(scale.x) - F(delta.x)) + floor(uv.y / F(scale.y) - F(delta.y));
    const Mask<F> is_even = floor(sum * F(0.5f)) * F(2) == sum;
    return select(is_even, Color<F>{F(even.r), F(even.g), F(even.b)}, Color<F>{F(odd.r), F(odd.g), F(odd.b)});
  }
};

extern const Plugin checkerboard_plugin;
Checkerboard make_checkerboard(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

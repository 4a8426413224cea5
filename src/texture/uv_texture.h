// A picture of the surface coordinates themselves, to look at them.
#pragma once

#include "base/color.h"
#include "base/simd_math.h"
#include "scenefile/parameters.h"

namespace etendue {

/// Red is u, green v, each modulo 1 and with a ripple of 8 periods a unit, blue 0.5; as in the forks of
/// Tuebingen.
struct UvTexture {
  template <class F>
  Color<F> at(const Vec2<F>& uv, const Mask<F>& /*lanes*/) const {
    const auto fraction = [](const F& x) { return x - floor(x); };
    const F u = fraction(abs(uv.x)), v = fraction(abs(uv.y));
    F sin_u, cos_u, sin_v, cos_v;
    sincos_turns(fraction(F(8) * uv.x), sin_u, cos_u);
    sincos_turns(fraction(F(8) * uv.y), sin_v, cos_v);
    return {u * (F(1) - F(0.2f) * sin_u * sin_v), v * (F(1) - F(0.2f) * cos_u * sin_v), F(0.5f)};
  }
};

extern const Plugin uv_texture_plugin;
UvTexture make_uv_texture(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

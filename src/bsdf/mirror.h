// A perfect mirror, one-sided: a Dirac delta in the mirror direction.
#pragma once

#include "base/color.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/lit_side.h"
#include "scenefile/parameters.h"

#include <limits>

namespace etendue {

struct Mirror {
  static constexpr std::int32_t lit_sides = lit_side::none;
  bool is_diffuse() const { return false; }
  bool has_texture() const { return false; }
  template <class F>
  Mirror at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return {};
  }

  template <class F>
  Color<F> eval(const Vec3<F>& /*wo_local*/, const Vec3<F>& /*wi_local*/) const {
    return black<F>();
  }
  template <class F>
  F pdf_solid_angle(const Vec3<F>& /*wo_local*/, const Vec3<F>& /*wi_local*/) const {
    return F(0);
  }

  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& /*u_bsdf*/) const {
    const Mask<F> is_above = wo_local.z > F(0);
    const F one = select(is_above, F(1), F(0));
    return {{-wo_local.x, -wo_local.y, wo_local.z},
            {one, one, one},
            select(is_above, F(std::numeric_limits<float>::infinity()), F(0))};
  }
};

extern const Plugin mirror_plugin;
Mirror make_mirror(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

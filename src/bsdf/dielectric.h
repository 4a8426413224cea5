// A smooth boundary between two dielectrics, such as glass in air: Dirac reflection and refraction.
#pragma once

#include "base/color.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/fresnel.h"
#include "bsdf/lit_side.h"
#include "bsdf/refractive_indices.h"
#include "scenefile/parameters.h"

#include <limits>

namespace etendue {

/// Reflects with the probability that Fresnel's equations give, by u_bsdf.x, else refracts. The weight of a
/// refracted direction is (eta_o / eta_i)^2, the change of radiance across the boundary.
struct Dielectric {
  RefractiveIndices indices;

  static constexpr std::int32_t lit_sides = lit_side::none;
  bool is_diffuse() const { return false; }
  bool has_texture() const { return false; }
  template <class F>
  Dielectric at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return *this;
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
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const Mask<F> is_outside = wo_local.z >= F(0);
    const F eta = indices.across<F>(is_outside), inverse_eta = indices.across<F>(mask_not(is_outside));
    const Refraction<F> refraction = refract(abs(wo_local.z), eta);
    const Mask<F> is_reflected = u_bsdf.x < refraction.reflectance;
    const Vec3<F> reflected{-wo_local.x, -wo_local.y, wo_local.z};
    const Vec3<F> refracted{-wo_local.x * inverse_eta, -wo_local.y * inverse_eta,
                            select(is_outside, -refraction.cos_theta_t, refraction.cos_theta_t)};
    const F weight = select(is_reflected, F(1), inverse_eta * inverse_eta);
    return {select(is_reflected, reflected, refracted),
            {weight, weight, weight},
            F(std::numeric_limits<float>::infinity()),
            select(is_reflected, F(1), eta)};
  }
};

extern const Plugin dielectric_plugin;
Dielectric make_dielectric(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

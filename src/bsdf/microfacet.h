// Nori's microfacet model: a diffuse base and a Beckmann lobe of a dielectric boundary, one-sided.
#pragma once

#include "base/color.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/fresnel.h"
#include "bsdf/lit_side.h"
#include "bsdf/lobe_choice.h"
#include "bsdf/microfacet_distribution.h"
#include "bsdf/refractive_indices.h"

namespace etendue {

/// f = kd / pi + ks D F G / (4 cos_i cos_o), ks = 1 - max(kd), after Walter et al. 2007, "Microfacet models
/// for refraction through rough surfaces", eq. 20, with their rational approximation of Beckmann's shadowing.
/// Sampling takes the lobe with probability ks, by the density D(h) cos_h of all half vectors h, else the
/// cosine.
struct Microfacet {
  Colorf kd{0.5f, 0.5f, 0.5f};
  float ks = 0.5f;
  MicrofacetDistribution distribution;  ///< Beckmann's.
  RefractiveIndices indices;

  static constexpr std::int32_t lit_sides = lit_side::front;
  bool has_texture() const { return false; }
  template <class F>
  const Microfacet& at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return *this;
  }

  template <class F>
  Color<F> eval(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Mask<F> is_above = mask_and(wo_local.z > F(0), wi_local.z > F(0));
    const Vec3<F> h = normalize(wo_local + wi_local);
    const F reflectance = refract(max(dot(wo_local, h), F(0)), F(indices.inside_over_outside)).reflectance;
    const F lobe = distribution.density(h) * reflectance * shadowing_over_cos(wo_local.z) *
                   shadowing_over_cos(wi_local.z) * F(0.25f * ks);
    const auto channel = [&](float diffuse) { return select(is_above, lobe + F(diffuse * inv_pi), F(0)); };
    return {channel(kd.r), channel(kd.g), channel(kd.b)};
  }

  template <class F>
  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Vec3<F> h = normalize(wo_local + wi_local);
    const F lobe = distribution.density(h) * h.z / (F(4) * dot(wo_local, h));
    const F mixture = F(ks) * lobe + F(1 - ks) * cosine_hemisphere_pdf_solid_angle(wi_local.z);
    return select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), mixture, F(0));
  }

  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const LobeChoice<F> lobe(u_bsdf.x, ks);
    const Vec3<F> h = distribution.sample_normal(Vec2<F>{lobe.u, u_bsdf.y});
    const Vec3<F> mirrored = h * (F(2) * dot(wo_local, h)) - wo_local;
    const Vec3<F> wi_local =
        select(lobe.is_first, mirrored, square_to_cosine_hemisphere(Vec2<F>{lobe.u, u_bsdf.y}));
    const F pdf = pdf_solid_angle(wo_local, wi_local);
    const F cos_over_pdf = select(pdf > F(0), wi_local.z / max(pdf, F(1e-37f)), F(0));
    return {wi_local, eval(wo_local, wi_local) * cos_over_pdf, pdf};
  }

 private:
  /// G1 / cos(theta): Walter et al. 2007, the approximation below eq. 27.
  template <class F>
  F shadowing_over_cos(const F& cos_theta) const {
    const F stretched_sin = F(distribution.alpha) * sqrt(max(F(1) - cos_theta * cos_theta, F(0)));
    // b = cos_theta / stretched_sin, multiplied out so that neither may be 0.
    const F numerator = F(3.535f) * stretched_sin + F(2.181f) * cos_theta;
    const F denominator =
        stretched_sin * stretched_sin + cos_theta * (F(2.276f) * stretched_sin + F(2.577f) * cos_theta);
    const Mask<F> is_shadowed = cos_theta < F(1.6f) * stretched_sin;
    return select(is_shadowed, numerator / max(denominator, F(1e-30f)), F(1) / max(cos_theta, F(1e-30f)));
  }
};

extern const Plugin microfacet_plugin;
Microfacet make_microfacet(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

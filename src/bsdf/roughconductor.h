// A rough metal, one-sided: reflection by microfacets.
#pragma once

#include "base/color.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/fresnel.h"
#include "bsdf/lit_side.h"
#include "bsdf/microfacet_distribution.h"

namespace etendue {

/// f = D F G / (4 cos_i cos_o): Walter et al. 2007, "Microfacet models for refraction through rough
/// surfaces", eq. 20; sampled by the normals that wo sees, so that the weight is F G1(wi). Where Zaragoza's
/// R0 is stated, F is Schlick's and G the rational approximation, as there.
struct RoughConductor {
  enum class Fresnel { exact, schlick };
  MicrofacetDistribution distribution;
  Colorf eta, k;  ///< Complex refractive index, relative to the outside.
  Colorf specular_reflectance{1, 1, 1};
  Fresnel fresnel_term = Fresnel::exact;
  Colorf r0{};  ///< Schlick's: reflectance along the normal.

  static constexpr std::int32_t lit_sides = lit_side::front;
  bool is_diffuse() const { return false; }
  bool has_texture() const { return false; }
  template <class F>
  const RoughConductor& at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return *this;
  }

  template <class F>
  Color<F> eval(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Vec3<F> h = normalize(wo_local + wi_local);
    const F scale =
        distribution.density(h) * shadowing_over_cos(wo_local.z) * shadowing_over_cos(wi_local.z) * F(0.25f);
    const Mask<F> is_above = mask_and(wo_local.z > F(0), wi_local.z > F(0));
    return select(is_above, fresnel(dot(wo_local, h)) * scale, black<F>());
  }

  template <class F>
  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Vec3<F> h = normalize(wo_local + wi_local);
    const F pdf = distribution.density(h) * distribution.shadowing_over_cos(wo_local.z) * F(0.25f);
    return select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), pdf, F(0));
  }

  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const Vec3<F> wo{wo_local.x, wo_local.y, abs(wo_local.z)};  // From below it only must stay a number.
    const Vec3<F> h = distribution.sample_visible(wo, u_bsdf);
    const F cos_h = dot(wo, h);
    const Vec3<F> wi_local = h * (F(2) * cos_h) - wo;
    const Mask<F> is_above = mask_and(wo_local.z > F(0), wi_local.z > F(0));
    const F seen = distribution.shadowing_over_cos(wo.z);
    const F pdf = distribution.density(h) * seen * F(0.25f);
    F shadowing = shadowing_over_cos(wi_local.z) * wi_local.z;
    if (fresnel_term == Fresnel::schlick) shadowing = shadowing * shadowing_over_cos(wo.z) / seen;
    return {wi_local, select(is_above, fresnel(cos_h) * shadowing, black<F>()), select(is_above, pdf, F(0))};
  }

 private:
  template <class F>
  F shadowing_over_cos(const F& cos_theta) const {
    return fresnel_term == Fresnel::exact ? distribution.shadowing_over_cos(cos_theta)
                                          : distribution.rational_shadowing_over_cos(cos_theta);
  }

  template <class F>
  Color<F> fresnel(const F& cos_h) const {
    const F cosine = min(max(cos_h, F(0)), F(1));
    if (fresnel_term == Fresnel::schlick)
      return {schlick_reflectance(cosine, r0.r), schlick_reflectance(cosine, r0.g),
              schlick_reflectance(cosine, r0.b)};
    return {conductor_reflectance(cosine, eta.r, k.r) * F(specular_reflectance.r),
            conductor_reflectance(cosine, eta.g, k.g) * F(specular_reflectance.g),
            conductor_reflectance(cosine, eta.b, k.b) * F(specular_reflectance.b)};
  }
};

extern const Plugin roughconductor_plugin;
RoughConductor make_roughconductor(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

// A diffuse base under a rough dielectric coat, one-sided: Nori's microfacet, Zaragoza's roughsubstrate.
#pragma once

#include "base/color.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/fresnel.h"
#include "bsdf/lit_side.h"
#include "bsdf/lobe_choice.h"
#include "bsdf/microfacet_distribution.h"
#include "bsdf/refractive_indices.h"

namespace etendue {

/// f = base + ks D F G / (4 cos_i cos_o) after Walter et al. 2007, "Microfacet models for refraction through
/// rough surfaces", eq. 20, with their rational approximation of Beckmann's shadowing. The base is Lambert's
/// (microfacet, ks = 1 - max(kd)), or what the coat lets through of it (roughsubstrate, ks = 1): Ashikhmin
/// and Shirley 2000, "An anisotropic Phong BRDF model", eq. 5. Sampling takes the lobe with
/// `coat_probability`, by the density D(h) cos_h of all half vectors h, else the cosine.
struct Microfacet {
  Colorf kd{0.5f, 0.5f, 0.5f};
  float ks = 0.5f;
  float coat_probability = 0.5f;
  MicrofacetDistribution distribution;  ///< Beckmann's.
  RefractiveIndices indices;
  enum class Base { lambert, under_coat };
  Base base = Base::lambert;
  float reflectance_along_normal = 0;  ///< Of the coat; the base under it needs it.

  static constexpr std::int32_t lit_sides = lit_side::front;
  bool is_diffuse() const { return false; }
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
    const F lobe = distribution.density(h) * reflectance *
                   distribution.rational_shadowing_over_cos(wo_local.z) *
                   distribution.rational_shadowing_over_cos(wi_local.z) * F(0.25f * ks);
    const F over_kd = base_over_kd(wo_local.z, wi_local.z);
    const auto channel = [&](float diffuse) { return select(is_above, lobe + F(diffuse) * over_kd, F(0)); };
    return {channel(kd.r), channel(kd.g), channel(kd.b)};
  }

  template <class F>
  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Vec3<F> h = normalize(wo_local + wi_local);
    const F lobe = distribution.density(h) * h.z / (F(4) * dot(wo_local, h));
    const F mixture =
        F(coat_probability) * lobe + F(1 - coat_probability) * cosine_hemisphere_pdf_solid_angle(wi_local.z);
    return select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), mixture, F(0));
  }

  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const LobeChoice<F> lobe(u_bsdf.x, coat_probability);
    const Vec3<F> h = distribution.sample_normal(Vec2<F>{lobe.u, u_bsdf.y});
    const Vec3<F> mirrored = h * (F(2) * dot(wo_local, h)) - wo_local;
    const Vec3<F> wi_local =
        select(lobe.is_first, mirrored, square_to_cosine_hemisphere(Vec2<F>{lobe.u, u_bsdf.y}));
    const F pdf = pdf_solid_angle(wo_local, wi_local);
    const F cos_over_pdf = select(pdf > F(0), wi_local.z / max(pdf, F(1e-37f)), F(0));
    return {wi_local, eval(wo_local, wi_local) * cos_over_pdf, pdf};
  }

 private:
  /// The base's f over kd.
  template <class F>
  F base_over_kd(const F& cos_o, const F& cos_i) const {
    if (base == Base::lambert) return F(inv_pi);
    const auto transmitted = [](const F& cosine) {
      const F rest = F(1) - F(0.5f) * cosine, rest_sq = rest * rest;
      return F(1) - rest_sq * rest_sq * rest;
    };
    return F(28 / (23 * pi) * (1 - reflectance_along_normal)) * transmitted(cos_i) * transmitted(cos_o);
  }
};

extern const Plugin microfacet_plugin, roughsubstrate_plugin;
Microfacet make_microfacet(const Object& description, std::vector<UnreadKey>& unread);
Microfacet make_roughsubstrate(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

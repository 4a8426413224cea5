// A rough boundary between two dielectrics, such as ground glass: reflection and refraction by microfacets.
#pragma once

#include "base/color.h"
#include "base/split_unit.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/fresnel.h"
#include "bsdf/lit_side.h"
#include "bsdf/microfacet_distribution.h"
#include "bsdf/refractive_indices.h"

namespace etendue {

/// Walter et al. 2007, "Microfacet models for refraction through rough surfaces", eq. 20 and 21, where wo is
/// their o: f carries radiance, with the factor (eta_o / eta_i)^2 across the boundary. Sampled by the normals
/// that wo sees, each of which reflects with the probability of Fresnel's equations: the weight is G1(wi),
/// and the factor.
struct RoughDielectric {
  MicrofacetDistribution distribution;
  RefractiveIndices indices;  ///< Not equal.

  static constexpr std::int32_t lit_sides = lit_side::front | lit_side::back;
  bool is_diffuse() const { return false; }
  bool has_texture() const { return false; }
  template <class F>
  const RoughDielectric& at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return *this;
  }

  template <class F>
  Color<F> eval(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Facet<F> facet(*this, wo_local, wi_local);
    const F f = facet.visible * distribution.shadowing_over_cos(abs(wi_local.z));
    return {f, f, f};
  }

  template <class F>
  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const Facet<F> facet(*this, wo_local, wi_local);
    return facet.visible * facet.pdf_over_visible;
  }

  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const Vec2<F> u_split = split_unit(u_bsdf.x);
    const Mask<F> is_outside = wo_local.z >= F(0);
    const F side = select(is_outside, F(1), F(-1));
    const F eta = indices.across<F>(is_outside), inverse_eta = indices.across<F>(mask_not(is_outside));
    const Vec3<F> wo{wo_local.x, wo_local.y, abs(wo_local.z)};

    const Vec3<F> h = distribution.sample_visible(wo, Vec2<F>{u_split.y, u_bsdf.y});
    const F cos_o = dot(wo, h);
    const Refraction<F> refraction = refract(max(cos_o, F(0)), eta);
    const Mask<F> is_reflected = u_split.x < refraction.reflectance;
    const F cos_difference = cos_o * inverse_eta - refraction.cos_theta_t;
    const Vec3<F> wi = select(is_reflected, h * (F(2) * cos_o) - wo, h * cos_difference - wo * inverse_eta);

    const F visible = distribution.density(h) * distribution.shadowing_over_cos(wo.z);
    const F reflected = F(0.25f) * refraction.reflectance;
    const F refracted =
        (F(1) - refraction.reflectance) * cos_o * refraction.cos_theta_t / (cos_difference * cos_difference);
    const F height = select(is_reflected, wi.z, -wi.z);
    const Mask<F> is_there = mask_and(wo.z > F(0), cos_o > F(0), height > F(0));
    const F weight = distribution.shadowing_over_cos(height) * height *
                     select(is_reflected, F(1), inverse_eta * inverse_eta);
    const F weight_there = select(is_there, weight, F(0));
    return {{wi.x, wi.y, wi.z * side},
            {weight_there, weight_there, weight_there},
            select(is_there, visible * select(is_reflected, reflected, refracted), F(0)),
            select(is_reflected, F(1), eta)};
  }

 private:
  /// The microfacets that send light from wi to wo.
  template <class F>
  struct Facet {
    F visible;           ///< f without G1(wi) / cos(theta_i).
    F pdf_over_visible;  ///< pdf / visible

    Facet(const RoughDielectric& model, const Vec3<F>& wo_local, const Vec3<F>& wi_local) {
      const Mask<F> is_outside = wo_local.z >= F(0);
      const F eta = model.indices.across<F>(is_outside);
      const Vec3<F> wo{wo_local.x, wo_local.y, abs(wo_local.z)};
      const Vec3<F> wi{wi_local.x, wi_local.y, select(is_outside, wi_local.z, -wi_local.z)};
      const Mask<F> is_reflection = wi.z > F(0);
      // Eq. 13 and 16; the length of `along` is the denominator of eq. 17.
      const Vec3<F> along = wo + wi * select(is_reflection, F(1), eta);
      const F length_sq = dot(along, along);
      const Vec3<F> h = along * (select(along.z < F(0), F(-1), F(1)) / sqrt(length_sq));
      const F cos_o = dot(wo, h), cos_i = dot(wi, h);
      const F reflectance = refract(max(cos_o, F(0)), eta).reflectance;
      const Mask<F> is_refraction = mask_and(wi.z < F(0), cos_i < F(0));
      const F refracted = select(is_refraction, (reflectance - F(1)) * cos_o * cos_i / length_sq, F(0));
      const F share = select(is_reflection, F(0.25f) * reflectance, refracted);
      visible =
          select(mask_and(wo.z > F(0), cos_o > F(0)),
                 share * model.distribution.density(h) * model.distribution.shadowing_over_cos(wo.z), F(0));
      pdf_over_visible = select(is_reflection, F(1), eta * eta);
    }
  };
};

extern const Plugin roughdielectric_plugin;
RoughDielectric make_roughdielectric(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

// The modified Phong model: a diffuse part and a glossy lobe about the mirror direction.
#pragma once

#include "base/color.h"
#include "base/frame.h"
#include "base/warp.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/lit_side.h"
#include "bsdf/lobe_choice.h"
#include "scenefile/parameters.h"

namespace etendue {

/// f = kd / pi + ks (n + 2) / (2 pi) cos^n(alpha), alpha between wi and the mirror image of wo (Lafortune and
/// Willems 1994, "Using the modified Phong reflectance model for physically based rendering", eq. 3).
/// Sampling takes the lobe with probability `specular_probability`, with density (n + 1) / (2 pi)
/// cos^n(alpha), else the cosine.
struct Phong {
  Colorf kd{0.5f, 0.5f, 0.5f}, ks{0.5f, 0.5f, 0.5f};
  float exponent = 20;
  float specular_probability = 0.5f;

  static constexpr std::int32_t lit_sides = lit_side::front;
  bool is_diffuse() const { return ks == Colorf{0, 0, 0}; }
  bool has_texture() const { return false; }
  template <class F>
  const Phong& at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return *this;
  }

  template <class F>
  Color<F> eval(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const auto is_above = mask_and(wo_local.z > F(0), wi_local.z > F(0));
    const F lobe = lobe_power(wo_local, wi_local) * F((exponent + 2) * 0.5f * inv_pi);
    const auto channel = [&](float diffuse, float specular) {
      return select(is_above, F(diffuse * inv_pi) + F(specular) * lobe, F(0));
    };
    return {channel(kd.r, ks.r), channel(kd.g, ks.g), channel(kd.b, ks.b)};
  }

  template <class F>
  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const F lobe = lobe_power(wo_local, wi_local) * F((exponent + 1) * 0.5f * inv_pi);
    const F mixture = F(specular_probability) * lobe +
                      F(1 - specular_probability) * cosine_hemisphere_pdf_solid_angle(wi_local.z);
    return select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), mixture, F(0));
  }

  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const LobeChoice<F> lobe(u_bsdf.x, specular_probability);
    const Frame<F> mirror_frame({-wo_local.x, -wo_local.y, wo_local.z});
    const Vec3<F> around_mirror =
        mirror_frame.world_from_local(square_to_power_cosine(Vec2<F>{lobe.u, u_bsdf.y}, F(exponent)));
    const Vec3<F> around_normal = square_to_cosine_hemisphere(Vec2<F>{lobe.u, u_bsdf.y});
    const Vec3<F> wi_local = select(lobe.is_first, around_mirror, around_normal);
    const F pdf = pdf_solid_angle(wo_local, wi_local);
    const F cos_over_pdf = select(pdf > F(0), wi_local.z / max(pdf, F(1e-37f)), F(0));
    return {wi_local, eval(wo_local, wi_local) * cos_over_pdf, pdf};
  }

 private:
  /// cos^n(alpha)
  template <class F>
  F lobe_power(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const F cos_alpha = wi_local.z * wo_local.z - wi_local.x * wo_local.x - wi_local.y * wo_local.y;
    return pow_positive(min(max(cos_alpha, F(0)), F(1)), F(exponent));
  }
};

extern const Plugin phong_plugin;
/// The convention (whose names, defaults and rescaling) follows from the names used; see
/// docs/scene_format.md.
Phong make_phong(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

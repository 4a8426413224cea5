// Lambert's diffuse reflection, one-sided.
#pragma once

#include "base/color.h"
#include "base/warp.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/lit_side.h"
#include "texture/texture.h"

namespace etendue {

/// f = albedo / pi
template <class F>
struct DiffuseBsdf {
  Color<F> albedo;  ///< Fraction of the light that is reflected.

  Color<F> eval(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    return albedo * select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), F(inv_pi), F(0));
  }

  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    return select(wo_local.z > F(0), cosine_hemisphere_pdf_solid_angle(wi_local.z), F(0));
  }

  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const Vec3<F> wi_local = square_to_cosine_hemisphere(u_bsdf);
    const F pdf = pdf_solid_angle(wo_local, wi_local);
    return {wi_local, albedo * select(pdf > F(0), F(1), F(0)), pdf};
  }
};

struct Diffuse {
  ColorTexture albedo = Colorf{0.5f, 0.5f, 0.5f};

  static constexpr std::int32_t lit_sides = lit_side::front;
  bool is_diffuse() const { return true; }
  bool has_texture() const { return !is_uniform(albedo); }
  template <class F>
  DiffuseBsdf<F> at(const Vec2<F>& uv, const Mask<F>& lanes) const {
    return {color_at(albedo, uv, lanes)};
  }
};

extern const Plugin diffuse_plugin;
Diffuse make_diffuse(const Object& description, TextureFiles& files, std::vector<UnreadKey>& unread);

}  // namespace etendue

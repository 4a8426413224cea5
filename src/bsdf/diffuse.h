// Lambert's diffuse reflection, one-sided.
#pragma once

#include "base/color.h"
#include "base/warp.h"
#include "bsdf/bsdf_sample.h"
#include "scenefile/parameters.h"

namespace etendue {

/// f = albedo / pi
template <class F>
struct DiffuseAt {
  Color<F> albedo;  ///< Fraction of the light that is reflected.

  Color<F> eval_(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    return albedo * select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), F(inv_pi), F(0));
  }

  F pdf_solid_angle_(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    return select(wo_local.z > F(0), cosine_hemisphere_pdf_solid_angle(wi_local.z), F(0));
  }

  BsdfSample<F> sample_(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const Vec3<F> wi_local = square_to_cosine_hemisphere(u_bsdf);
    const F pdf = pdf_solid_angle_(wo_local, wi_local);
    return {wi_local, albedo * select(pdf > F(0), F(1), F(0)), pdf};
  }
};

struct Diffuse {
  Colorf albedo{0.5f, 0.5f, 0.5f};

  bool has_texture() const { return false; }
  template <class F>
  DiffuseAt<F> at(const Vec2<F>& /*uv*/, const Mask<F>& /*lanes*/) const {
    return {{F(albedo.r), F(albedo.g), F(albedo.b)}};
  }
};

extern const Plugin diffuse_plugin;
Diffuse make_diffuse(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

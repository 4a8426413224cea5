// Lambert's diffuse reflection, one-sided.
#pragma once

#include "base/color.h"
#include "base/warp.h"
#include "bsdf/bsdf_sample.h"
#include "scenefile/parameters.h"

namespace etendue {

struct Diffuse {
  Colorf albedo{0.5f, 0.5f, 0.5f};

  template <class F>
  Color<F> eval_(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const F f = select(mask_and(wo_local.z > F(0), wi_local.z > F(0)), F(inv_pi), F(0));
    return {f * F(albedo.r), f * F(albedo.g), f * F(albedo.b)};
  }

  template <class F>
  F pdf_solid_angle_(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    return select(wo_local.z > F(0), cosine_hemisphere_pdf_solid_angle(wi_local.z), F(0));
  }

  template <class F>
  BsdfSample<F> sample_(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    const Vec3<F> wi_local = square_to_cosine_hemisphere(u_bsdf);
    const F pdf = pdf_solid_angle_(wo_local, wi_local);
    const F one = select(pdf > F(0), F(1), F(0));
    return {wi_local, {one * F(albedo.r), one * F(albedo.g), one * F(albedo.b)}, pdf};
  }
};

extern const Plugin diffuse_plugin;
Diffuse make_diffuse(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

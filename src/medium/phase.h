// Phase functions: which way a medium scatters.
#pragma once

#include "base/warp.h"
#include "bsdf/bsdf_sample.h"

namespace etendue {

/// Henyey and Greenstein 1941, "Diffuse radiation in the galaxy", with directions as BSDFs have them: wo and
/// wi both point away from the place of scattering. It has the functions of a BsdfModel, so that media and
/// surfaces share the path stages; sampling is exact, and every weight is 1.
struct HenyeyGreenstein {
  float g = 0;  ///< Mean cosine between the ways in and out, in (-1, 1); 0: isotropic, > 0: forwards.

  template <class F>
  Color<F> eval(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const F p = pdf_solid_angle(wo_local, wi_local);
    return {p, p, p};
  }

  /// 1/sr
  template <class F>
  F pdf_solid_angle(const Vec3<F>& wo_local, const Vec3<F>& wi_local) const {
    const F squares = F(1 + g * g) + F(2 * g) * dot(wo_local, wi_local);
    return F((1 - g * g) * 0.25f * inv_pi) / (squares * sqrt(squares));
  }

  /// \param wo_local along +z or -z: the local frame of a vertex in a medium is that of its ray
  template <class F>
  BsdfSample<F> sample(const Vec3<F>& wo_local, const Vec2<F>& u_bsdf) const {
    // The inverse cancels towards g = 0; there its first two terms do.
    const F even = F(1) - F(2) * u_bsdf.x;
    F cos_onwards = even + F(1.5f * g) * (F(1) - even * even);
    constexpr float small = 1e-3f;
    if (g > small || g < -small) {
      const F ratio = F(1 - g * g) / (F(1 + g) - F(2 * g) * u_bsdf.x);
      cos_onwards = min(max((F(1 + g * g) - ratio * ratio) * F(0.5f / g), F(-1)), F(1));
    }
    F sine, cosine;
    sincos_turns(u_bsdf.y, sine, cosine);
    const F radius = sqrt(max(F(1) - cos_onwards * cos_onwards, F(0)));
    const Vec3<F> wi_local{radius * cosine, radius * sine, -wo_local.z * cos_onwards};
    return {wi_local, {F(1), F(1), F(1)}, pdf_solid_angle(wo_local, wi_local), F(1)};
  }
};

}  // namespace etendue

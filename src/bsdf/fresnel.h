// Fresnel's equations for unpolarised light.
#pragma once

#include "base/simd_math.h"

namespace etendue {

/// Light at the boundary of two dielectrics.
template <class F>
struct Refraction {
  F reflectance;  ///< The fraction that is reflected; 1 in total reflection.
  F cos_theta_t;  ///< Of the refracted direction to the normal on its side; 0 in total reflection.
};

/// `cos_theta` >= 0 on the side of the incident direction; `eta`: index of the other side over that of this
/// one.
template <class F>
Refraction<F> refract(const F& cos_theta, const F& eta) {
  // 1 - sin^2 / eta^2, written so that equal indices give cos_theta itself, at grazing angles too.
  const F inside = (eta - F(1)) * (eta + F(1)) + cos_theta * cos_theta;
  const Mask<F> is_refracted = inside > F(0);
  const F cos_theta_t = select(is_refracted, sqrt(max(inside, F(0))) / eta, F(0));
  const F near_s = eta * cos_theta_t, near_p = eta * cos_theta;
  const F r_s = (cos_theta - near_s) / (cos_theta + near_s),
          r_p = (near_p - cos_theta_t) / (near_p + cos_theta_t);
  return {select(is_refracted, F(0.5f) * (r_s * r_s + r_p * r_p), F(1)), cos_theta_t};
}

/// The fraction of light that a conductor of complex index `eta` + i `k` (>= 0, relative to the outside)
/// reflects; `cos_theta` >= 0. Pharr, Jakob and Humphreys 2016, "Physically Based Rendering", eq. 8.3
/// and 8.4.
template <class F>
F conductor_reflectance(const F& cos_theta, float eta, float k) {
  constexpr float tiny = 1e-30f;  // For 0 / 0 at cos_theta = 0, where all is reflected.
  const F cos_sq = cos_theta * cos_theta, sin_sq = F(1) - cos_sq;
  const F difference = F(eta * eta - k * k) - sin_sq;
  const F a_sq_plus_b_sq = sqrt(difference * difference + F(4 * eta * eta * k * k));
  const F a = sqrt(max(F(0.5f) * (a_sq_plus_b_sq + difference), F(0)));
  const F sum_s = a_sq_plus_b_sq + cos_sq + F(tiny), cross_s = F(2) * a * cos_theta;
  const F r_s = (sum_s - cross_s) / (sum_s + cross_s);
  const F sum_p = cos_sq * a_sq_plus_b_sq + sin_sq * sin_sq + F(tiny), cross_p = cross_s * sin_sq;
  const F r_p = r_s * (sum_p - cross_p) / (sum_p + cross_p);
  return F(0.5f) * (r_s + r_p);
}

/// Schlick 1994, "An inexpensive BRDF model for physically-based rendering", eq. 15; `r0` is the reflectance
/// along the normal, `cos_theta` in [0, 1].
template <class F>
F schlick_reflectance(const F& cos_theta, float r0) {
  const F rest = F(1) - cos_theta, rest_sq = rest * rest;
  return F(r0) + F(1 - r0) * rest_sq * rest_sq * rest;
}

}  // namespace etendue

// Warps of the unit square, each beside its density.
#pragma once

#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float inv_pi = 0.31830988618379067154f;

/// Barycentric coordinates (of vertices 1 and 2), uniform over a triangle; pdf_area = 1 / area.
/// The unit square is folded along its diagonal, which keeps distances (and so stratification) better than
/// the square-root map: Heitz 2019, "A low-distortion map between triangle and square".
template <class F>
Vec2<F> square_to_triangle(const Vec2<F>& u) {
  const auto is_above = u.y > u.x;
  const F x = select(is_above, u.x * F(0.5f), u.x - u.y * F(0.5f));
  const F y = select(is_above, u.y - u.x * F(0.5f), u.y * F(0.5f));
  return {x, y};
}

/// Cosine-weighted directions on the hemisphere around z.
template <class F>
Vec3<F> square_to_cosine_hemisphere(const Vec2<F>& u) {
  F sine, cosine;
  sincos_turns(u.y, sine, cosine);
  const F radius = sqrt(u.x);
  return {radius * cosine, radius * sine, sqrt(max(F(1) - u.x, F(0)))};
}
/// 1/sr; 0 below the horizon.
template <class F>
F cosine_hemisphere_pdf_solid_angle(const F& cos_theta) {
  return max(cos_theta, F(0)) * F(inv_pi);
}

/// Directions around z with density proportional to cos^n (Phong's lobe).
template <class F>
Vec3<F> square_to_power_cosine(const Vec2<F>& u, const F& exponent) {
  F sine, cosine;
  sincos_turns(u.y, sine, cosine);
  // 1 - cos without cancellation: the lobes of large exponents are narrow.
  const F one_minus_cos = -expm1(log(F(1) - u.x) / (exponent + F(1)));
  const F sin_alpha = sqrt(one_minus_cos * (F(2) - one_minus_cos));
  return {sin_alpha * cosine, sin_alpha * sine, F(1) - one_minus_cos};
}
/// (n + 1) / (2 pi) cos^n, in 1/sr; 0 for a negative cosine.
template <class F>
F power_cosine_pdf_solid_angle(const F& cos_alpha, const F& exponent) {
  return (exponent + F(1)) * F(0.5f * inv_pi) * pow_positive(max(cos_alpha, F(0)), exponent);
}

/// Directions uniform in the cone around z whose opening has 1 - cos = `one_minus_cos_max`.
template <class F>
Vec3<F> square_to_uniform_cone(const Vec2<F>& u, const F& one_minus_cos_max) {
  F sine, cosine;
  sincos_turns(u.y, sine, cosine);
  const F one_minus_cos = u.x * one_minus_cos_max;
  const F sin_theta = sqrt(max(one_minus_cos * (F(2) - one_minus_cos), F(0)));
  return {sin_theta * cosine, sin_theta * sine, F(1) - one_minus_cos};
}
template <class F>
F uniform_cone_pdf_solid_angle(const F& one_minus_cos_max) {
  return F(0.5f * inv_pi) / one_minus_cos_max;
}

/// Points uniform in the unit disk; density 1 / pi. Squares around the middle become circles, which keeps
/// distances better than polar coordinates: Shirley and Chiu 1997, "A low distortion map between disk and
/// square".
template <class F>
Vec2<F> square_to_uniform_disk(const Vec2<F>& u) {
  const F x = F(2) * u.x - F(1), y = F(2) * u.y - F(1);
  const auto is_wide = abs(x) > abs(y);
  const F radius = select(is_wide, x, y), other = select(is_wide, y, x);
  const F eighths = other / select(abs(radius) > F(0), radius, F(1));
  F sine, cosine;
  sincos_turns(F(0.125f) * eighths, sine, cosine);
  return {radius * select(is_wide, cosine, sine), radius * select(is_wide, sine, cosine)};
}

/// Points uniform on the unit sphere; density 1 / (4 pi).
template <class F>
Vec3<F> square_to_uniform_sphere(const Vec2<F>& u) {
  F sine, cosine;
  sincos_turns(u.y, sine, cosine);
  const F z = F(1) - F(2) * u.x;
  const F radius = sqrt(max(F(1) - z * z, F(0)));
  return {radius * cosine, radius * sine, z};
}

}  // namespace etendue

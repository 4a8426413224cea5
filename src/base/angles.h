// Angles of half a turn, by fewer instructions than those of any size.
#pragma once

#include "base/simd_math.h"

namespace etendue {

namespace polynomial {
/// c[0] + c[1] z + ...
template <class F, std::size_t n>
F value(const float (&c)[n], const F& z) {
  F sum(c[n - 1]);
  for (std::size_t k = n - 1; k-- > 0;) sum = sum * z + F(c[k]);
  return sum;
}
// Fitted to the least greatest error.
inline constexpr float sine[] = {1.0f, -0.166666582f, 0.00833305065f, -0.000198090755f, 2.60522484e-6f};
inline constexpr float cosine[] = {0.99999994f, -0.499999046f, 0.0416635834f, -0.00138537039f,
                                   2.31539307e-5f};
inline constexpr float arc_tangent[] = {1.0f,          -0.333330929f,  0.199930534f,
                                        -0.142071337f, 0.106546745f,   -0.075336702f,
                                        0.0430393f,    -0.0162829664f, 0.00290354202f};
}  // namespace polynomial

/// Sine and cosine of an angle in [0, pi]; to 4e-7, the sine of small angles to 3e-7 of itself.
template <class F>
void sincos_half_turn(const F& angle, F& sine, F& cosine) {
  const F half = F(0.5f) * angle, z = half * half;
  const F sine_of_half = half * polynomial::value(polynomial::sine, z),
          cosine_of_half = polynomial::value(polynomial::cosine, z);
  sine = F(2) * sine_of_half * cosine_of_half;
  cosine = (cosine_of_half - sine_of_half) * (cosine_of_half + sine_of_half);
}

/// The angle of (x, y), y >= 0, from the x axis, in [0, pi]; to 4e-7 of itself. 0 for (0, 0).
template <class F>
F half_turn_angle(const F& y, const F& x) {
  constexpr float half_pi = 1.57079632679489661923f, pi = 3.14159265358979323846f;
  const F size = abs(x), greater = max(size, y), lesser = min(size, y);
  const F slope = lesser / max(greater, F(1.17549435e-38f));
  const F angle = slope * polynomial::value(polynomial::arc_tangent, slope * slope);
  const F acute = select(y > size, F(half_pi) - angle, angle);
  return select(x < F(0), F(pi) - acute, acute);
}

}  // namespace etendue

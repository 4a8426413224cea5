// The error function and its inverse over lanes.
#pragma once

#include "base/simd_math.h"

namespace etendue {

/// erf(x) for x >= 0, given exp(-x^2), which callers need anyway. Error at most 1.5e-7: Abramowitz and Stegun
/// 1964, "Handbook of Mathematical Functions", eq. 7.1.26.
template <class F>
F erf_nonnegative(const F& x, const F& exp_of_minus_x_sq) {
  const F t = F(1) / (F(1) + F(0.3275911f) * x);
  const F p =
      t * (F(0.254829592f) +
           t * (F(-0.284496736f) + t * (F(1.421413741f) + t * (F(-1.453152027f) + t * F(1.061405429f)))));
  return F(1) - p * exp_of_minus_x_sq;
}

/// The x for which erf(x) = y, -1 < y < 1; relative error some 1e-6. Giles 2010, "Approximating the erfinv
/// function", single precision.
template <class F>
F inverse_erf(const F& y) {
  const F w = -log((F(1) - y) * (F(1) + y));
  const Mask<F> is_central = w < F(5);
  const F a = w - F(2.5f), b = sqrt(max(w, F(5))) - F(3);
  F central(2.81022636e-08f), tail(-0.000200214257f);
  for (const float c : {3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f, -0.00125372503f,
                        -0.00417768164f, 0.246640727f, 1.50140941f})
    central = F(c) + central * a;
  for (const float c : {0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f, -0.0076224613f,
                        0.00943887047f, 1.00167406f, 2.83297682f})
    tail = F(c) + tail * b;
  return y * select(is_central, central, tail);
}

}  // namespace etendue

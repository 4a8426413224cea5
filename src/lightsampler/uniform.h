// Which light: one of n, all alike.
#pragma once

#include "base/simd_math.h"

namespace etendue {

template <class F>
struct LightChoice {
  Int<F> light;
  UInt<F> u_left;  ///< The random number that chose, stretched back over 32 bits: still stratified.
  F pmf;
};

template <class F>
LightChoice<F> choose_light_uniformly(std::int32_t light_count, const UInt<F>& u_light) {
  const UInt<F> n = UInt<F>(std::uint32_t(light_count));
  return {as_int(mul_hi(u_light, n)), u_light * n, F(1.0f / float(light_count))};
}

/// The probability with which `choose_light_uniformly` gives any light.
inline float uniform_light_pmf(std::int32_t light_count) { return 1.0f / float(light_count); }

}  // namespace etendue

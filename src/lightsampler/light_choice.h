// What choosing a light gives.
#pragma once

#include "base/simd_math.h"

namespace etendue {

template <class F>
struct LightChoice {
  Int<F> light;
  /// The random number that chose, stretched back over 32 bits: still stratified, but with no more values
  /// than led to this light.
  UInt<F> u_left;
  F pmf;
};

}  // namespace etendue

// What choosing a light gives.
#pragma once

#include "base/simd_math.h"

namespace etendue {

template <class F>
struct LightChoice {
  Int<F> light;
  UInt<F> u_left;  ///< The random number that chose, stretched back over 32 bits: still stratified.
  F pmf;
};

}  // namespace etendue

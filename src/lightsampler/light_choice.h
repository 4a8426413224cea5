// What choosing a light gives.
#pragma once

#include "base/simd_math.h"
#include "light/light_sample.h"

namespace etendue {

template <class F>
struct LightChoice {
  Int<F> light;
  Int<F> facet;  ///< Of it; whole_light where samplers choose whole lights.
  /// The random number that chose, stretched back over 32 bits: still stratified, but with no more values
  /// than led to this light.
  UInt<F> u_left;
  F pmf;  ///< 0: no light reaches the receiver, and none was chosen.
  Int<F>
      rank;  ///< Among all that can be chosen: neighbours stand near each other, as far as the sampler knows.
};

template <class F>
LightChoice<F> select(const Mask<F>& m, const LightChoice<F>& a, const LightChoice<F>& b) {
  return {select(m, a.light, b.light), select(m, a.facet, b.facet),
          as_uint(select(m, as_int(a.u_left), as_int(b.u_left))), select(m, a.pmf, b.pmf),
          select(m, a.rank, b.rank)};
}

}  // namespace etendue

// The choice between two lobes by a random number that is then used again.
#pragma once

#include "base/simd_math.h"

namespace etendue {

/// The first lobe with probability `p`; `u` is uniform in [0, 1) again, whichever lobe it is.
template <class F>
struct LobeChoice {
  Mask<F> is_first;
  F u;

  LobeChoice(const F& u_lobe, float p) : is_first(u_lobe < F(p)) {
    const float scale_first = p > 0 ? 1 / p : 0, scale_second = p < 1 ? 1 / (1 - p) : 0;
    const F stretched = select(is_first, u_lobe * F(scale_first), (u_lobe - F(p)) * F(scale_second));
    u = min(stretched, F(0x1.fffffep-1f));
  }
};

}  // namespace etendue

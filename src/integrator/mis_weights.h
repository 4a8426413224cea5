// How the light sample and the BSDF sample of one point are combined: the only place with weights.
#pragma once

#include "base/simd_math.h"

namespace etendue {

/// alone: only one of the two is taken. half: both, each counted half (the plain average). balance, power:
/// multiple importance sampling, Veach 1997, "Robust Monte Carlo methods for light transport simulation",
/// eq. 9.8 and section 9.2.2.2 with exponent 2.
enum class Combination { alone, half, balance, power };

/// The weight of a sample drawn with density `pdf_own` that the other technique draws with `pdf_other` (both
/// 1/sr, pdf_own > 0; the light's density includes the probability of choosing it).
template <class F>
F mis_weight(Combination combination, const F& pdf_own, const F& pdf_other) {
  switch (combination) {
    case Combination::alone:
      return F(1);
    case Combination::half:
      return F(0.5f);
    case Combination::balance:
      return F(1) / (F(1) + pdf_other / pdf_own);
    case Combination::power:
      break;
  }
  const F ratio = pdf_other / pdf_own;
  return F(1) / (F(1) + ratio * ratio);
}

/// Whether the weight depends on the densities.
inline bool needs_both_pdfs(Combination combination) {
  return combination == Combination::balance || combination == Combination::power;
}

}  // namespace etendue

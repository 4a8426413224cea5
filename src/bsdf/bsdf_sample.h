// What sampling a BSDF gives.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

/// A direction drawn from a BSDF. Where the density is 0 the sample carries nothing: it fell where the model
/// scatters no light. Where it is infinite the lobe is a Dirac delta, and the weight the ratio of two deltas'
/// strengths.
template <class F>
struct BsdfSample {
  Vec3<F> wi_local;
  Color<F> weight;    ///< f cos(theta_i) / pdf
  F pdf_solid_angle;  ///< 1/sr
  F eta = F(1);       ///< Refractive index on wi's side over that on wo's side; 1 for a reflected direction.
};

template <class F>
BsdfSample<F> select(const Mask<F>& m, const BsdfSample<F>& a, const BsdfSample<F>& b) {
  return {select(m, a.wi_local, b.wi_local), select(m, a.weight, b.weight),
          select(m, a.pdf_solid_angle, b.pdf_solid_angle), select(m, a.eta, b.eta)};
}

}  // namespace etendue

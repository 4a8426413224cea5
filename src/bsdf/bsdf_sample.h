// What sampling a BSDF gives.
#pragma once

#include "base/color.h"
#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

/// A direction drawn from a BSDF. Where the density is 0 the sample carries nothing: it fell below the horizon.
template <class F>
struct BsdfSample {
  Vec3<F> wi_local;
  Color<F> weight;    ///< f cos(theta_i) / pdf
  F pdf_solid_angle;  ///< 1/sr
};

}  // namespace etendue

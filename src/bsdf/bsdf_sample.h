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

template <class F>
BsdfSample<F> select(const Mask<F>& m, const BsdfSample<F>& a, const BsdfSample<F>& b) {
  return {{select(m, a.wi_local.x, b.wi_local.x), select(m, a.wi_local.y, b.wi_local.y),
           select(m, a.wi_local.z, b.wi_local.z)},
          {select(m, a.weight.r, b.weight.r), select(m, a.weight.g, b.weight.g), select(m, a.weight.b, b.weight.b)},
          select(m, a.pdf_solid_angle, b.pdf_solid_angle)};
}

}  // namespace etendue

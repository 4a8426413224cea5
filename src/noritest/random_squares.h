// Uniform points of the unit square, by their number.
#pragma once

#include "sampler/sampler.h"

namespace etendue {

/// One stream of points; any of them can be asked for, from any thread.
class RandomSquares {
 public:
  RandomSquares(SamplerKind kind, std::uint64_t seed) : kind_(kind), stream_(hash64(seed)) {}

  Vec2f operator[](std::uint32_t index) const { return to_unit_floats<float>(bits(index)); }
  /// The same point as 32-bit fractions.
  Vec2<std::uint32_t> bits(std::uint32_t index) const {
    return sample_2d<float>(kind_, std::uint32_t(stream_), std::uint32_t(stream_ >> 32), index,
                            dimension::bsdf);
  }

 private:
  SamplerKind kind_;
  std::uint64_t stream_;
};

}  // namespace etendue

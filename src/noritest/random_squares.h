// Uniform points of the unit square, by their number.
#pragma once

#include "sampler/sampler.h"

namespace etendue {

/// One stream of independent points; any of them can be asked for, from any thread.
class RandomSquares {
 public:
  explicit RandomSquares(std::uint64_t seed) : stream_(hash64(seed)) {}

  Vec2f operator[](std::uint32_t index) const {
    return to_unit_floats<float>(sample_2d<float>(SamplerKind::independent, std::uint32_t(stream_),
                                                  std::uint32_t(stream_ >> 32), index, dimension::bsdf));
  }

 private:
  std::uint64_t stream_;
};

}  // namespace etendue

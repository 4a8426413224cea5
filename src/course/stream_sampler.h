// The numbers of one sample of a render, in the words of the course kit.
#pragma once

#include "course/calls.h"
#include "integrator/unlit_rules.h"
#include "sampler/sampler.h"

#include <nori/sampler.h>

namespace etendue {

/// The k-th call takes the k-th pair of dimensions behind the film's.
class StreamSampler final : public nori::Sampler {
 public:
  StreamSampler(SamplerKind kind, const SampleStream& stream) : kind_(kind), stream_(stream) {}

  float next1D() override {
    const Vec2f u = next();
    CallRecording::note(NumbersDrawn{1, u});
    return u.x;
  }
  nori::Point2f next2D() override {
    const Vec2f u = next();
    CallRecording::note(NumbersDrawn{2, u});
    return {u.x, u.y};
  }

 private:
  Vec2f next() {
    return to_unit_floats<float>(sample_2d<float>(kind_, stream_.lo, stream_.hi, stream_.index, ++pair_));
  }

  SamplerKind kind_;
  SampleStream stream_;
  std::uint32_t pair_ = dimension::film;
};

}  // namespace etendue

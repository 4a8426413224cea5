// Random numbers of one sample of a pixel.
#pragma once

#include <nori/object.h>

NORI_NAMESPACE_BEGIN

/// Each call gives the next numbers of this sample, uniform in [0, 1) and independent of those before. With
/// the scene's sampler `sobol` the k-th calls of a pixel's samples are well distributed together, so calls
/// should come in the same order in each. Any other source of random numbers makes an image that cannot be
/// repeated.
class NORI_SHARED Sampler : public NoriObject {
 public:
  virtual float next1D() = 0;
  virtual Point2f next2D() = 0;
};

NORI_NAMESPACE_END

// What a student writes: how much light a camera ray brings.
#pragma once

#include <nori/scene.h>

NORI_NAMESPACE_BEGIN

class NORI_SHARED Integrator : public NoriObject {
 public:
  /// One sample of the radiance (W/(m^2 sr)) that arrives along the ray; a pixel is the mean of its samples.
  /// Called from many threads at once, so nothing that it shares between calls may change.
  virtual Color3f Li(const Scene* scene, Sampler* sampler, const Ray3f& ray) const {
    return Li(*scene, *sampler, ray);
  }
  /// The same, as later frameworks spell it: a class has one of the two.
  virtual Color3f Li(const Scene& /*scene*/, Sampler& /*sampler*/, const Ray3f& /*ray*/) const {
    throw NoriException("the integrator has no Li");
  }
  /// Called once, before all calls of Li.
  virtual void preprocess(const Scene*) {}
};

NORI_NAMESPACE_END

// All that is rendered.
#pragma once

#include <nori/bsdf.h>
#include <nori/mesh.h>
#include <nori/sampler.h>

NORI_NAMESPACE_BEGIN

class NORI_SHARED Scene : public NoriObject {
 public:
  /// Whether anything lies between ray.mint and ray.maxt; `its` is the nearest of it.
  virtual bool rayIntersect(const Ray3f& ray, Intersection& its) const = 0;
  /// Whether anything lies between ray.mint and ray.maxt: what shadow rays need.
  virtual bool rayIntersect(const Ray3f& ray) const = 0;

  /// The lights that are surfaces.
  virtual const std::vector<Luminaire*>& getLuminaires() const = 0;
  const std::vector<Emitter*>& getEmitters() const { return getLuminaires(); }
  virtual const std::vector<Mesh*>& getMeshes() const = 0;
};

NORI_NAMESPACE_END

// Exercise 3: direct light by sampling the surfaces of the lights. Yours to complete.

// Your group's number.
#define GROUP_NUMBER 0

#include <nori/bsdf.h>
#include <nori/integrator.h>
#include <nori/luminaire.h>
#include <nori/mesh.h>
#include <nori/sampler.h>
#include <nori/scene.h>

NORI_NAMESPACE_BEGIN

class LightIntegrator : public Integrator {
 public:
  explicit LightIntegrator(const PropertyList& /*propList*/) {}

  /// One sample of the light that arrives at lRec.ref straight from the lights, but for the cosine there.
  /// \param lRec in: `ref`, the place that is lit. Out: what Li needs to know of the point on the light
  /// \param _sample uniform in the unit square
  inline Color3f sampleLights(const Scene* scene, LuminaireQueryRecord& lRec, const Point2d& _sample) const {
    (void)scene, (void)lRec, (void)_sample;

    // 1. Choose one of the scene's lights at random.

    // 2. Take a random point on its mesh: Mesh::samplePosition.

    // 3. Find out whether the two places see each other, the part of the geometry term that belongs to the
    //    light, and the density of the point: Mesh::pdf.

    // 4. Return the light's radiance with all of these.

    return Color3f(0.0f);
  }

  /// One sample of the radiance that arrives along a camera ray.
  Color3f Li(const Scene* scene, Sampler* sampler, const Ray3f& ray_) const override {
    (void)sampler;

    Intersection its;
    if (!scene->rayIntersect(ray_, its)) return Color3f(0.0f);

    // Ask sampleLights for the light that arrives, and the BSDF for how much of it is reflected.

    return Color3f(0.0f);
  }
};

NORI_REGISTER_CLASS(LightIntegrator, "light");

NORI_NAMESPACE_END

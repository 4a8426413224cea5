// The exercise's integrator with all the names that files of 2012 have, and in the later spelling of Li.
#include <nori/acg.h>
#include <nori/bsdf.h>
#include <nori/common.h>
#include <nori/emitter.h>
#include <nori/integrator.h>
#include <nori/luminaire.h>
#include <nori/sampler.h>
#include <nori/scene.h>
#include <vector>

NORI_NAMESPACE_BEGIN

#define GROUP_NUMBER 12

GROUP_NAMESPACE_BEGIN()

class LightIntegrator : public Integrator {
 public:
  LightIntegrator(const PropertyList& propList) { Q_UNUSED(propList); }

  inline const Mesh* getMesh(const Luminaire* lum) const {
    const Mesh* mesh = dynamic_cast<const Mesh*>(lum->getParent());
    if (!mesh) throw NoriException("a light that is no mesh");
    return mesh;
  }

  inline Color3f sampleLights(const Scene* scene, LuminaireQueryRecord& lRec, const Point2f& _sample) const {
    Point2f sample(_sample);
    const std::vector<Luminaire*>& luminaires = scene->getLuminaires();
    int index = std::min((int)(luminaires.size() * sample.x()), (int)luminaires.size() - 1);
    sample.x() = luminaires.size() * sample.x() - index;
    lRec.luminaire = luminaires[index];
    const Mesh* mesh = getMesh(lRec.luminaire);
    mesh->samplePosition(sample, lRec.p, lRec.n);
    lRec.d = lRec.p - lRec.ref;
    lRec.dist = lRec.d.norm();
    lRec.d /= lRec.dist;
    float cosine = lRec.n.dot(-lRec.d);
    if (cosine <= 0 || scene->rayIntersect(Ray3f(lRec.ref, lRec.d, Epsilon, lRec.dist * (1 - 1e-4f))))
      return Color3f(0.0f);
    return lRec.luminaire->getColor() * cosine / (lRec.dist * lRec.dist) * luminaires.size() / mesh->pdf();
  }

  Color3f Li(const Scene* scene, Sampler* sampler, const Ray3f& ray_) const {
    Ray3f ray(ray_);
    Intersection its;
    Color3f result(0.0f);
    if (!scene->rayIntersect(ray, its)) return result;
    if (its.mesh->isEmitter())
      result += its.mesh->getEmitter()->eval(EmitterQueryRecord(ray.o, its.p, its.shFrame.n));
    LuminaireQueryRecord lRec(its.p);
    Color3f direct = sampleLights(scene, lRec, sampler->next2D());
    if ((direct.array() != 0).any()) {
      BSDFQueryRecord bRec(its.toLocal(-ray.d), its.toLocal(lRec.d), ESolidAngle);
      result += direct * its.mesh->getBSDF()->eval(bRec) * std::max(0.0f, Frame::cosTheta(bRec.wo));
    }
    return result;
  }

  QString toString() const { return QString("LightIntegrator[]"); }
};

class LaterIntegrator : public Integrator {
 public:
  explicit LaterIntegrator(const PropertyList&) {}
  Color3f Li(const Scene& scene, Sampler& sampler, const Ray3f& ray) const override {
    return LightIntegrator(PropertyList()).Li(&scene, &sampler, ray);
  }
};

GROUP_NAMESPACE_END

NORI_REGISTER_GROUP_CLASS(LightIntegrator, "light");
NORI_REGISTER_GROUP_CLASS(LaterIntegrator, "later");

NORI_NAMESPACE_END

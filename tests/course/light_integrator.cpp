// The exercise's integrator as a student may write it: area sampling of the lights, in the course kit's
// words.
#define GROUP_NUMBER 7

#include <nori/integrator.h>

NORI_NAMESPACE_BEGIN

class LightIntegrator : public Integrator {
 public:
  explicit LightIntegrator(const PropertyList&) {}

  Color3f sampleLights(const Scene* scene, LuminaireQueryRecord& lRec, const Point2d& _sample) const {
    const std::vector<Luminaire*>& luminaires = scene->getLuminaires();
    if (luminaires.empty()) throw NoriException("the scene has no lights");

    // One light, each as likely; what is left of the number is uniform again.
    Point2d sample = _sample;
    const auto count = float(luminaires.size());
    const float chosen = std::min(std::floor(sample.x() * count), count - 1);
    sample.x() = sample.x() * count - chosen;
    lRec.luminaire = luminaires[std::size_t(chosen)];

    // A point on it.
    const Mesh* mesh = lRec.luminaire->getMesh();
    mesh->samplePosition(sample, lRec.p, lRec.n);
    lRec.pdf = mesh->pdf() / count;
    lRec.d = lRec.p - lRec.ref;
    lRec.dist = lRec.d.norm();
    lRec.d /= lRec.dist;

    // Geometry term, without the cosine at the receiver; visibility.
    const float cos_theta_light = -lRec.n.dot(lRec.d);
    if (cos_theta_light <= 0) return Color3f(0.0f);
    if (scene->rayIntersect(Ray3f(lRec.ref, lRec.d, Epsilon, lRec.dist * (1 - 1e-4f)))) return Color3f(0.0f);
    return lRec.luminaire->eval(lRec) * (cos_theta_light / (lRec.dist * lRec.dist) / lRec.pdf);
  }

  Color3f Li(const Scene* scene, Sampler* sampler, const Ray3f& ray) const override {
    Intersection its;
    if (!scene->rayIntersect(ray, its)) return Color3f(0.0f);

    Color3f radiance(0.0f);
    if (const Luminaire* seen = its.mesh->getLuminaire())
      radiance += seen->eval(LuminaireQueryRecord(seen, ray.o, its.p, its.geoFrame.n));

    LuminaireQueryRecord lRec(its.p);
    const Color3f arriving = sampleLights(scene, lRec, sampler->next2D());
    const BSDFQueryRecord bRec(its.toLocal(-ray.d), its.toLocal(lRec.d), ESolidAngle);
    const float cos_theta = Frame::cosTheta(bRec.wo);
    if (cos_theta > 0) radiance += its.mesh->getBSDF()->eval(bRec) * arriving * cos_theta;
    return radiance;
  }
};

NORI_REGISTER_CLASS(LightIntegrator, "light");

NORI_NAMESPACE_END

#include "course/student_scene.h"

#include "base/frame.h"
#include "bsdf/bsdf.h"
#include "course/calls.h"
#include "course/student_words.h"
#include "course/surface_sampling.h"
#include "integrator/single_sample.h"
#include "integrator/vertex.h"

#include <cmath>
#include <deque>
#include <mutex>
#include <string>

namespace etendue {

namespace {

nori::Frame frame_around(const Vec3f& normal) {
  const Frame<float> frame(normal);
  return {to_student(frame.s), to_student(frame.t), to_student(frame.n)};
}

/// A material as a BSDF: the viewer is `wo` here and `wi` there.
class StudentBsdf final : public nori::BSDF {
 public:
  StudentBsdf(const Material& material, std::int32_t id) : material_(&material), id_(id) {}

  nori::Color3f eval(const nori::BSDFQueryRecord& bRec) const override {
    Colorf value{0, 0, 0};
    if (bRec.measure != nori::EDiscrete)
      with_model(bRec.uv,
                 [&](const auto& bsdf) { value = bsdf.eval(from_student(bRec.wi), from_student(bRec.wo)); });
    note(BsdfAsked::What::value, bRec, value, 0, {0, 0});
    return to_student(value);
  }
  float pdf(const nori::BSDFQueryRecord& bRec) const override {
    float density = 0;
    if (bRec.measure != nori::EDiscrete)
      with_model(bRec.uv, [&](const auto& bsdf) {
        density = bsdf.pdf_solid_angle(from_student(bRec.wi), from_student(bRec.wo));
      });
    note(BsdfAsked::What::density, bRec, {0, 0, 0}, density, {0, 0});
    return density;
  }
  nori::Color3f sample(nori::BSDFQueryRecord& bRec, const nori::Point2f& sample) const override {
    BsdfSample<float> drawn{};
    with_model(bRec.uv,
               [&](const auto& bsdf) { drawn = bsdf.sample(from_student(bRec.wi), from_student(sample)); });
    bRec.wo = to_student(drawn.wi_local);
    bRec.eta = drawn.eta;
    bRec.measure = std::isinf(drawn.pdf_solid_angle) ? nori::EDiscrete : nori::ESolidAngle;
    note(BsdfAsked::What::sample, bRec, drawn.weight, drawn.pdf_solid_angle, from_student(sample));
    return to_student(drawn.weight);
  }
  bool isDiffuse() const override {
    return std::visit([](const auto& model) { return model.is_diffuse(); }, *material_);
  }

 private:
  template <class Function>
  void with_model(const nori::Point2f& uv, Function&& f) const {
    std::visit([&](const auto& model) { f(model.at(from_student(uv), true)); }, *material_);
  }
  void note(BsdfAsked::What what, const nori::BSDFQueryRecord& bRec, const Colorf& value, float density,
            const Vec2f& u) const {
    if (CallRecording::is_on())
      CallRecording::note(
          BsdfAsked{what, id_, from_student(bRec.wi), from_student(bRec.wo), value, density, u});
  }

  const Material* material_;
  std::int32_t id_;
};

class StudentMesh;

class StudentLuminaire final : public nori::Luminaire {
 public:
  StudentLuminaire(const StudentMesh& mesh, std::int32_t geometry, const Colorf& radiance, bool is_twosided)
      : mesh_(&mesh), geometry_(geometry), radiance_(radiance), is_twosided_(is_twosided) {}

  nori::Color3f eval(const nori::LuminaireQueryRecord& lRec) const override {
    const bool is_seen = is_twosided_ || lRec.n.dot(lRec.d) < 0;
    const Colorf radiance = is_seen ? radiance_ : Colorf{0, 0, 0};
    if (CallRecording::is_on())
      CallRecording::note(EmissionAsked{geometry_, true, from_student(lRec.p), from_student(lRec.n),
                                        from_student(lRec.d), radiance});
    return to_student(radiance);
  }
  nori::Color3f getColor() const override {
    CallRecording::note(EmissionAsked{geometry_, false, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, radiance_});
    return to_student(radiance_);
  }
  const nori::Mesh* getMesh() const override;
  const nori::NoriObject* getParent() const override;

 private:
  const StudentMesh* mesh_;
  std::int32_t geometry_;
  Colorf radiance_;
  bool is_twosided_;
};

class StudentMesh final : public nori::Mesh {
 public:
  StudentMesh(const Geometry& geometry, std::int32_t id, std::string name, const StudentBsdf& bsdf)
      : geometry_(&geometry), id_(id), name_(std::move(name)), bsdf_(&bsdf) {}

  void samplePosition(const nori::Point2f& sample, nori::Point3f& p, nori::Normal3f& n) const override {
    const SurfaceSampling::Point point = surface().sample(from_student(sample));
    p = to_student(point.position);
    n = to_student(point.ng);
    if (CallRecording::is_on())
      CallRecording::note(PointSampled{id_, from_student(sample), point.position, point.ng});
  }
  float pdf() const override {
    CallRecording::note(DensityAsked{id_, surface().pdf_area()});
    return surface().pdf_area();
  }
  int getTriangleCount() const override { return geometry_->triangles[std::size_t(id_)]; }
  const nori::Luminaire* getLuminaire() const override { return luminaire_; }
  const nori::BSDF* getBSDF() const override { return bsdf_; }
  const std::string& getName() const override { return name_; }

  void shine(const StudentLuminaire& luminaire) { luminaire_ = &luminaire; }

 private:
  /// Made when it is first asked for: most meshes are not.
  const SurfaceSampling& surface() const {
    std::call_once(once_, [&] { surface_.emplace(*geometry_, id_); });
    return *surface_;
  }

  const Geometry* geometry_;
  std::int32_t id_;
  std::string name_;
  const StudentBsdf* bsdf_;
  const StudentLuminaire* luminaire_ = nullptr;
  mutable std::once_flag once_;
  mutable std::optional<SurfaceSampling> surface_;
};

const nori::Mesh* StudentLuminaire::getMesh() const { return mesh_; }
const nori::NoriObject* StudentLuminaire::getParent() const { return mesh_; }

}  // namespace

struct StudentScene::Parts {
  std::deque<StudentBsdf> bsdfs;
  std::deque<StudentMesh> meshes;
  std::deque<StudentLuminaire> luminaires;
};

StudentScene::StudentScene(const etendue::Scene& scene, const ScenePlaces& places)
    : scene_(scene), parts_(std::make_unique<Parts>()) {
  for (std::int32_t id = 0; id < scene.materials.count(); ++id)
    parts_->bsdfs.emplace_back(scene.materials[id], id);
  const Geometry& geometry = scene.geometry;
  for (std::int32_t id = 0; id < geometry.count(); ++id) {
    const auto row = std::size_t(id);
    StudentMesh& mesh = parts_->meshes.emplace_back(geometry, id, places.shapes[row].name,
                                                    parts_->bsdfs[std::size_t(geometry.material[row])]);
    meshes_.push_back(&mesh);
    const std::int32_t light = geometry.light[row];
    if (light < 0) continue;
    if (scene.lights.is_textured(light))
      throw InputError(places.lights[std::size_t(light)].where,
                       "the radiance of this light is a texture, which luminaires of the course kit have not",
                       "give it one radiance");
    mesh.shine(parts_->luminaires.emplace_back(mesh, id, scene.lights.largest_radiance(light),
                                               scene.lights.is_twosided<float>(light, true)));
    luminaires_.push_back(&parts_->luminaires.back());
  }
}

StudentScene::~StudentScene() = default;

bool StudentScene::rayIntersect(const nori::Ray3f& ray, nori::Intersection& its) const {
  const Ray<float> cast{from_student(ray.o), from_student(ray.d)};
  const Hit<float> hit = closest_hit(scene_, cast, ray.mint, ray.maxt);
  CallRecording::note(RayCast{cast, ray.mint, ray.maxt, false, hit.geometry, hit.t});
  its = {};
  if (hit.geometry < 0) return false;
  const Vertex<float> vertex(scene_, cast, hit);
  its.p = to_student(vertex.position);
  its.t = hit.t;
  its.uv = to_student(vertex.uv);
  its.shFrame = frame_around(vertex.ns);
  its.geoFrame = frame_around(vertex.ng);
  its.mesh = meshes_[std::size_t(hit.geometry)];
  return true;
}

bool StudentScene::rayIntersect(const nori::Ray3f& ray) const {
  const Ray<float> cast{from_student(ray.o), from_student(ray.d)};
  const Hit<float> hit = closest_hit(scene_, cast, ray.mint, ray.maxt);
  CallRecording::note(RayCast{cast, ray.mint, ray.maxt, true, hit.geometry, hit.t});
  return hit.geometry >= 0;
}

}  // namespace etendue

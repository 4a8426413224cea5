// A scene in the words of the course kit, over the renderer's single samples: what a student's code is
// handed.
#pragma once

#include "scene/scene.h"
#include "scene/scene_places.h"

#include <memory>
#include <nori/scene.h>
#include <vector>

namespace etendue {

/// Meshes stand in the order of the scene's geometry, luminaires in that of their meshes. Lights that are no
/// surfaces are not among them. What is asked of it and of its parts is noted (course/calls.h).
class StudentScene final : public nori::Scene {
 public:
  /// `scene` must outlive it and stay where it is. Throws InputError for a light whose radiance is a texture.
  StudentScene(const etendue::Scene& scene, const ScenePlaces& places);
  ~StudentScene() override;

  bool rayIntersect(const nori::Ray3f& ray, nori::Intersection& its) const override;
  bool rayIntersect(const nori::Ray3f& ray) const override;
  const std::vector<nori::Luminaire*>& getLuminaires() const override { return luminaires_; }
  const std::vector<nori::Mesh*>& getMeshes() const override { return meshes_; }

 private:
  struct Parts;
  const etendue::Scene& scene_;
  std::unique_ptr<Parts> parts_;
  std::vector<nori::Luminaire*> luminaires_;
  std::vector<nori::Mesh*> meshes_;
};

}  // namespace etendue

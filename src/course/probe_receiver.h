// The place that a probe's ray meets, and the light that truly arrives there.
#pragma once

#include "course/light_terms.h"
#include "course/probe.h"
#include "course/student_scene.h"
#include "scene/load_scene.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// A probe, ready to be looked at.
struct LoadedProbe {
  LoadedProbe(const Probe& of, const std::filesystem::path& folder);

  const Probe& probe;
  LoadedScene loaded;
  StudentScene scene;
  std::vector<std::int32_t> light_of_mesh;  ///< In the order of Scene::getLuminaires; -1: none.
  std::vector<std::int32_t> mesh_of_light;
  std::vector<double> light_areas;  ///< m^2
};

/// What a ray to a receiver should bring.
struct ExpectedRadiance {
  Color<double> mean{0, 0, 0};  ///< W/(m^2 sr)
  /// Of samples that take each light alike and points uniform on it: mean squared over mean square, in (0,
  /// 1]. Small where few of them bring nearly all; 1 where nothing comes.
  Color<double> evenness{1, 1, 1};
};

class ProbeReceiver {
 public:
  /// `probe` must outlive it.
  ProbeReceiver(const LoadedProbe& probe, const ProbeRay& ray);

  bool is_surface() const { return is_surface_; }
  /// Of the surface itself towards the camera.
  Colorf emitted() const;
  bool is_light() const { return is_surface_ && hit_.mesh->isLuminaire(); }
  const nori::Mesh* mesh() const { return hit_.mesh; }

  /// Of a point on the light with this mesh; the choice of it and what the student's code saw are the
  /// caller's.
  LightPointFacts facts(std::int32_t mesh, const Vec3f& position, const Vec3f& ng) const;

  /// Radiance towards the camera: emitted, and reflected of all lights, by a fine grid on each triangle.
  ExpectedRadiance expected() const;

 private:
  /// But for visibility.
  LightPointFacts unshadowed_facts(std::int32_t mesh, const Vec3f& position, const Vec3f& ng) const;
  void find_visibility(LightPointFacts& facts) const;

  const LoadedProbe& probe_;
  Vec3f to_camera_;
  bool is_surface_;
  nori::Intersection hit_;
};

}  // namespace etendue

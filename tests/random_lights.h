// Lights of all kinds that have a place, at random: what choices among many lights are tested with.
#pragma once

#include "light/light.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace etendue {

/// Where they are, and how large.
struct LightSwarm {
  int count = 1;
  float extent = 1;   ///< Their centres lie in a cube of twice this side around `center`, m.
  float size = 0.1f;  ///< Of one, m.
  Vec3f center{0, 0, 0};
};

class RandomPlaces {
 public:
  explicit RandomPlaces(std::uint32_t seed) : engine_(seed) {}

  std::uint32_t word() { return std::uint32_t(engine_()); }
  int below(int n) { return int(word() % std::uint32_t(n)); }
  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  /// 10^low .. 10^high
  float magnitude(float low, float high) { return std::pow(10.0f, uniform(low, high)); }
  Vec3f direction() {
    std::normal_distribution<float> normal;
    while (true) {
      const Vec3f v{normal(engine_), normal(engine_), normal(engine_)};
      if (length_sq(v) > 1e-6f) return normalize(v);
    }
  }
  Vec3f in_cube(float half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937 engine_;
};

/// A mesh of so many triangles that do not touch each other.
inline void add_triangles(Lights& lights, RandomPlaces& random, int count, const LightSwarm& swarm,
                          float radiance) {
  Mesh mesh;
  for (int t = 0; t < count; ++t) {
    const Vec3f at = swarm.center + random.in_cube(swarm.extent);
    const Vec3f u = random.direction() * swarm.size, v = random.direction() * swarm.size;
    for (const Vec3f& corner : {at, at + u, at + v}) {
      mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
      mesh.positions.push_back(corner);
    }
  }
  Geometry geometry;
  const std::int32_t id = geometry.add_mesh(mesh, {0, lights.count()});
  lights.add<MeshLights>({radiance, radiance, radiance}, "", geometry, id);
}

/// One in nine is black; those of the kinds that are surfaces may be two-sided.
inline Lights random_lights(RandomPlaces& random, const LightSwarm& swarm) {
  Lights lights;
  for (int k = 0; k < swarm.count; ++k) {
    const float radiance = k % 9 == 4 ? 0 : random.magnitude(-3, 0);
    const Colorf strength{radiance, radiance, radiance};
    const Vec3f at = swarm.center + random.in_cube(swarm.extent);
    const Vec3f u = random.direction() * swarm.size, v = random.direction() * swarm.size;
    switch (random.below(6)) {
      case 0:
        lights.add<RectangleLights>(strength, "", at, u, v);
        break;
      case 1:
        lights.add<SphereLights>(strength, "", Sphere{at, swarm.size});
        continue;
      case 2:
        lights.add<DiskLights>(strength, "", Disk{at, u, v, normalize(cross(u, v))});
        break;
      case 3:
        lights.add<PointLights>(strength, "", at);
        continue;
      case 4: {
        const float cutoff = random.uniform(0.1f, pi);
        lights.add<SpotLights>(strength, "", SpotLight{at, normalize(u), 0.5f * cutoff, cutoff, strength});
        continue;
      }
      default:
        add_triangles(lights, random, 1 + random.below(4),
                      {.extent = swarm.size, .size = swarm.size, .center = at}, radiance);
    }
    if (random.below(4) == 0) lights.set_twosided(lights.count() - 1);
  }
  return lights;
}

}  // namespace etendue

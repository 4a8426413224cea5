// Probe rays: a few hundred rays, always the same ones, that tell what is where.
#pragma once

#include "base/hash.h"
#include "base/split_unit.h"
#include "base/warp.h"
#include "bsdf/bsdf.h"
#include "integrator/single_sample.h"
#include "integrator/vertex.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// Numbers that look random, the same in each run.
class ProbeNumbers {
 public:
  explicit ProbeNumbers(std::uint64_t seed) : state_(seed) {}
  std::uint32_t bits() { return std::uint32_t(hash64(state_++) >> 32); }
  Vec2<std::uint32_t> two_bits() {
    const std::uint32_t x = bits();
    return {x, bits()};
  }
  float unit() { return float(bits() >> 8) * 0x1p-24f; }  ///< In [0, 1).
  Vec2f two_units() {
    const float x = unit();
    return {x, unit()};
  }

 private:
  std::uint64_t state_;
};

/// The surface that a probe ray has met.
struct ProbeHit {
  Hit<float> hit;
  Vertex<float> vertex;
  bool is_front;  ///< The ray met the side that the normal points to.
};
/// Nothing where the ray leaves the scene.
std::optional<ProbeHit> probe(const Scene& scene, const Ray<float>& ray, float t_near = 0,
                              float t_far = std::numeric_limits<float>::infinity());
/// A ray that leaves the surface along `direction`.
inline Ray<float> ray_from(const ProbeHit& from, const Vec3f& direction) {
  return {from.vertex.origin_of_ray(direction), direction};
}

/// What the checks ask of a material.
struct MaterialFacts {
  Colorf albedo;      ///< The largest that it has anywhere; 1 of mirrors and dielectrics.
  bool is_dirac;      ///< A mirror or smooth dielectric: light samples add nothing there.
  bool is_two_sided;  ///< A dielectric; the others are black from behind.
  bool is_absorbing;  ///< Whatever its colours: metals, and coats over a base.

  float largest_albedo() const { return std::max({albedo.r, albedo.g, albedo.b}); }
};
std::vector<MaterialFacts> facts_of(const Materials& materials);

/// What the camera sees, by rays through a grid of the film, and what it would see without clip planes.
struct View {
  struct Seen {
    Ray<float> ray;
    float t_near, t_far;  ///< The clip planes.
    std::optional<ProbeHit> hit, unclipped;
  };
  std::vector<Seen> rays;
  int hits = 0, unclipped_hits = 0, fronts = 0;
};
View look(const Scene& scene);

/// Whether a place (world, m) is within the image and between the clip planes, hidden or not.
bool is_in_view(const Camera& camera, const Vec3f& place);

/// Where the light of `light` arrives at what a probe ray has met: whether one of `tries` samples of it is
/// visible from there, from the side that the ray has met.
bool is_lit_by(const Scene& scene, const ProbeHit& at, std::int32_t light, int tries, ProbeNumbers& numbers);

/// A direction in which a path may go on from a surface: through dielectrics and off the side it has met.
Vec3f next_direction(const ProbeHit& from, const MaterialFacts& material, ProbeNumbers& numbers);

}  // namespace etendue

// What the camera sees at the centre of each pixel: for layers that tell other tools of the scene.
#pragma once

#include "geometry/ray.h"
#include "scene/scene.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace etendue {

/// Of the ray through a pixel's centre, and through the centre of the lens.
struct FirstHit {
  Vec3<double> position{0, 0, 0};                           ///< In the file's world, m.
  float distance = std::numeric_limits<float>::infinity();  ///< From the camera, along the ray, m.
  Vec3f normal{0, 0, 0};                                    ///< The shading normal, unit, in the world.
  /// The share of the light from all around that is scattered to the camera, by 16 BSDF samples: exact of
  /// what is diffuse or a mirror.
  Colorf albedo{0, 0, 0};
  std::int32_t shape = -1, material = -1, light = -1;  ///< Ids; -1: none.
};

struct CentreHit {
  Ray<float> ray;
  Hit<float> hit;
};
/// What the ray through the centre of a pixel, and of the lens, meets.
CentreHit centre_hit(const Scene& scene, int x, int y);

/// Of all pixels, rows from the top.
std::vector<FirstHit> first_hits(const Scene& scene);

}  // namespace etendue

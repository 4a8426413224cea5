// Lights that rays have met on a side that shines.
#pragma once

#include "geometry/ray.h"
#include "geometry/surface_uv.h"
#include "scene/scene.h"

namespace etendue {

/// Where rays have hit a light on a side that shines.
template <class F>
struct HitOnLight {
  Mask<F> is_there;
  Int<F> light;
  Vec3<F> ng;  ///< Unit, on the side that the ray comes from.

  HitOnLight(const Scene& scene, const Ray<F>& ray, const Hit<F>& hit)
      : is_there(less(Int<F>(-1), hit.geometry)) {
    light = gather(scene.geometry.light.data(), select(is_there, hit.geometry, Int<F>(0)));
    is_there = mask_and(is_there, less(Int<F>(-1), light));
    if (!any(is_there)) return;
    ng = normalize(hit.ng);
    const F cos_theta_ray = dot(ng, ray.direction);
    const Mask<F> is_turned = mask_and(scene.lights.is_twosided<F>(light, is_there), cos_theta_ray > F(0));
    ng = select(is_turned, -ng, ng);
    is_there = mask_and(is_there, mask_or(is_turned, cos_theta_ray < F(0)));
  }

  /// What it sends along the rays, W/(m^2 sr).
  Color<F> radiance(const Scene& scene, const Hit<F>& hit) const {
    return scene.lights.radiance<F>(light, is_there, [&](const Mask<F>& lanes) {
      return surface_uv<F>(scene.geometry, hit.geometry, hit.primitive, hit.barycentric, ng, lanes);
    });
  }
};

}  // namespace etendue

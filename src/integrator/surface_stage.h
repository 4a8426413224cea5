// What rays hit, and the light that hit surfaces emit.
#pragma once

#include "integrator/mis_weights.h"
#include "integrator/sample_block.h"
#include "integrator/surface_point.h"
#include "light/light.h"
#include "scene/scene.h"

namespace etendue {

template <class F>
void cast_rays(const Scene& scene, const RayColumns& rays, HitColumns& hits, int count, Coherence coherence) {
  scene.rays.closest_hits({rays.origin.x.data(), rays.origin.y.data(), rays.origin.z.data(),
                           rays.direction.x.data(), rays.direction.y.data(), rays.direction.z.data(),
                           rays.t_near.data(), rays.t_far.data(), rays.is_active.data(), count},
                          {hits.t.data(), hits.ng.x.data(), hits.ng.y.data(), hits.ng.z.data(), hits.u.data(),
                           hits.v.data(), hits.geometry.data(), hits.primitive.data()},
                          lane_count_v<F>, coherence);
}

/// Casts the camera's rays.
template <class F>
void closest_hits(const Scene& scene, SampleBlock& block) {
  cast_rays<F>(scene, block.camera_ray, block.camera_hit, block.padded_count, Coherence::coherent);
  block.clock.finish(Stage::closest_hits);
}

/// Radiance emitted towards where the rays came from, by the lights among what they hit. `f(i, lanes, light,
/// emitted, ng)` is called for packets with any such lane.
template <class F, class Function>
void for_each_emission(const Scene& scene, const RayColumns& rays, const HitColumns& hits, int count,
                       Function&& f) {
  for (int i = 0; i < count; i += lane_count_v<F>) {
    const Int<F> geometry = load_lanes<Int<F>>(&hits.geometry[i]);
    const Mask<F> is_hit = less(Int<F>(-1), geometry);
    const Int<F> light = gather(scene.geometry.light.data(), select(is_hit, geometry, Int<F>(0)));
    const Mask<F> is_light = mask_and(is_hit, less(Int<F>(-1), light));
    if (!any(is_light)) continue;
    const HitNormals<F> normals(scene, hits, i, is_light);
    const Vec3<F> direction = load_lanes<F>(rays.direction, i);
    const Mask<F> is_front =
        mask_and(is_light, dot(normals.ng, direction) < F(0), dot(normals.ns, direction) < F(0));
    if (!any(is_front)) continue;
    f(i, is_front, light, scene.lights.radiance<F>(light, is_front), normals.ng);
  }
}

/// Starts the sum of a sample: what the camera sees of a light.
template <class F>
void add_emission(const Scene& scene, SampleBlock& block) {
  block.radiance.r.fill(0);
  block.radiance.g.fill(0);
  block.radiance.b.fill(0);
  for_each_emission<F>(
      scene, block.camera_ray, block.camera_hit, block.padded_count,
      [&](int i, const Mask<F>& lanes, const Int<F>&, const Color<F>& emitted, const Vec3<F>&) {
        store_lanes(block.radiance, i, select(lanes, emitted, black<F>()));
      });
  block.clock.finish(Stage::emission);
}

}  // namespace etendue

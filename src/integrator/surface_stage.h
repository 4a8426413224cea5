// What rays hit: the surface under the camera's ray, and the light that a hit surface emits.
#pragma once

#include "integrator/mis_weights.h"
#include "integrator/sample_block.h"
#include "integrator/surface_point.h"
#include "light/light.h"
#include "scene/scene.h"

namespace etendue {

/// Casts the block's rays; hits go to the hit columns.
template <class F>
void cast_rays(const Scene& scene, SampleBlock& block, Coherence coherence) {
  const RaySpan rays{block.ray_origin.x.data(),    block.ray_origin.y.data(),    block.ray_origin.z.data(),
                     block.ray_direction.x.data(), block.ray_direction.y.data(), block.ray_direction.z.data(),
                     block.ray_t_near.data(),      block.ray_t_far.data(),       block.ray_is_active.data(),
                     block.padded_count};
  const HitSpan hits{block.hit_t.data(), block.hit_ng.x.data(),    block.hit_ng.y.data(),     block.hit_ng.z.data(),
                     block.hit_u.data(), block.hit_v.data(),       block.hit_geometry.data(), block.hit_primitive.data()};
  scene.rays.closest_hits(rays, hits, lane_count_v<F>, coherence);
}

/// A hit's normals, in the lanes of `is_hit`.
template <class F>
struct HitNormals {
  Vec3<F> ng;  ///< Unit.
  Vec3<F> ns;  ///< Unit; ng where the shape has no vertex normals.

  HitNormals(const Scene& scene, const SampleBlock& block, int i, const Mask<F>& is_hit) {
    ng = normalize(load_lanes<F>(block.hit_ng, i));
    ns = ng;
    if (!scene.geometry.has_any_normals) return;
    const Int<F> geometry = select(is_hit, load_lanes<Int<F>>(&block.hit_geometry[i]), Int<F>(0));
    const Mask<F> is_smooth = mask_and(is_hit, equal(gather(scene.geometry.has_normals.data(), geometry), Int<F>(1)));
    if (!any(is_smooth)) return;
    const Vec2<F> barycentric{load_lanes<F>(&block.hit_u[i]), load_lanes<F>(&block.hit_v[i])};
    const Vec3<F> smooth = normalize(interpolate_normal<F>(
        scene.geometry, geometry, load_lanes<Int<F>>(&block.hit_primitive[i]), barycentric, is_smooth));
    ns = {select(is_smooth, smooth.x, ng.x), select(is_smooth, smooth.y, ng.y), select(is_smooth, smooth.z, ng.z)};
  }
};

/// Casts the camera's rays and finds position, normals and material of what they hit.
template <class F>
void closest_hits(const Scene& scene, SampleBlock& block) {
  cast_rays<F>(scene, block, Coherence::coherent);
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Int<F> geometry = load_lanes<Int<F>>(&block.hit_geometry[i]);
    const Mask<F> is_hit = less(Int<F>(-1), geometry);
    const Vec3<F> direction = load_lanes<F>(block.ray_direction, i);
    const HitNormals<F> normals(scene, block, i, is_hit);
    const F distance = load_lanes<F>(&block.hit_t[i]);
    const Vec3<F> position = load_lanes<F>(block.ray_origin, i) + direction * distance;
    store_lanes(block.position, i, position);
    store_lanes(&block.clearance[i], ray_clearance(position, distance));
    store_lanes(block.ng, i, normals.ng);
    store_lanes(block.ns, i, normals.ns);
    store_lanes(block.wo, i, -direction);
    const Int<F> material = gather(scene.geometry.material.data(), select(is_hit, geometry, Int<F>(0)));
    store_lanes(&block.material[i], select(is_hit, material, Int<F>(-1)));
  }
  block.clock.finish(Stage::closest_hits);
}

/// Radiance emitted towards where the cast rays came from, by the lights among what they hit. `f(i, lanes, light,
/// emitted, ng)` is called for packets with any such lane.
template <class F, class Function>
void for_each_emission(const Scene& scene, const SampleBlock& block, Function&& f) {
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Int<F> geometry = load_lanes<Int<F>>(&block.hit_geometry[i]);
    const Mask<F> is_hit = less(Int<F>(-1), geometry);
    const Int<F> light = gather(scene.geometry.light.data(), select(is_hit, geometry, Int<F>(0)));
    const Mask<F> is_light = mask_and(is_hit, less(Int<F>(-1), light));
    if (!any(is_light)) continue;
    const HitNormals<F> normals(scene, block, i, is_light);
    const Vec3<F> direction = load_lanes<F>(block.ray_direction, i);
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
  for_each_emission<F>(scene, block, [&](int i, const Mask<F>& lanes, const Int<F>&, const Color<F>& emitted, const Vec3<F>&) {
    store_lanes(block.radiance, i,
                Color<F>{select(lanes, emitted.r, F(0)), select(lanes, emitted.g, F(0)), select(lanes, emitted.b, F(0))});
  });
  block.clock.finish(Stage::emission);
}

}  // namespace etendue

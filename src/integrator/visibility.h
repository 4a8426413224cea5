// How much of the hemisphere above a surface is open: average visibility and ambient occlusion.
#pragma once

#include "base/frame.h"
#include "base/warp.h"
#include "integrator/bsdf_stage.h"
#include "integrator/camera_stage.h"
#include "integrator/hit_stage.h"
#include "integrator/unlit_rules.h"
#include "integrator/vertex.h"

#include <algorithm>

namespace etendue {

/// For each path: a direction in the hemisphere around the shading normal, and the ray along it.
template <class F>
void sample_hemisphere(const Scene& scene, SampleBlock& block, const VisibilityRules& rules) {
  for (int i = 0; i < block.path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(block.path.ray, i), load_hit<F>(block.path.hit, i));
    const Vec2<F> u_bsdf = to_unit_floats<F>(sample_bits<F>(scene, block.path, i, dimension::bsdf));
    const Vec3<F> wi_local =
        rules.is_cosine_weighted ? square_to_cosine_hemisphere(u_bsdf) : square_to_uniform_cone(u_bsdf, F(1));
    const Vec3<F> wi = Frame<F>(vertex.ns).world_from_local(wi_local);
    store_mask<F>(&block.next_ray.is_active[i], vertex.is_surface);
    store_lanes(block.next_ray.origin, i, vertex.origin_of_ray(wi));
    store_lanes(block.next_ray.direction, i, wi);
  }
  block.clock.finish(Stage::bsdf_samples);
}

/// Adds grey to the samples whose rays meet nothing.
template <class F>
void add_to_misses(SampleBlock& block, float grey) {
  const PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Mask<F> is_miss =
        mask_and(load_mask<F>(&path.hit.geometry[i]), load_mask<F>(&path.ray.is_active[i]));
    add_radiance<F>(block, i, is_miss, {F(grey), F(grey), F(grey)});
  }
  block.clock.finish(Stage::emission);
}

/// Each sample: 1 where a ray in a random direction above what the camera sees is free, else 0.
template <class F>
void visibility(const Scene& scene, SampleBlock& block, const VisibilityRules& rules) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block, Coherence::coherent);
  add_to_misses<F>(block, rules.background);
  sample_hemisphere<F>(scene, block, rules);
  follow_paths<F>(block, false);
  std::fill_n(block.path.ray.t_far.begin(), block.path.padded_count, rules.length);
  closest_hits<F>(scene, block, Coherence::incoherent);
  add_to_misses<F>(block, 1);
}

}  // namespace etendue

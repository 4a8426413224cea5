// One point light over white surfaces, whatever the scene says of its lights and materials: the first
// integrator with shadows of Nori's exercises.
#pragma once

#include "base/warp.h"
#include "integrator/camera_stage.h"
#include "integrator/hit_stage.h"
#include "integrator/light_stage.h"
#include "integrator/unlit_rules.h"
#include "integrator/vertex.h"

namespace etendue {

/// For each path: the shadow segment to the light, and what the light adds where it is visible, energy / (4
/// pi^2) max(0, cos theta) / distance^2.
template <class F>
void sample_simple_light(const Scene& scene, SampleBlock& block, const SimpleLight& light) {
  const Vec3<F> light_position{F(light.position.x), F(light.position.y), F(light.position.z)};
  block.shadow.samples = 1;
  block.shadow.stride = block.path.padded_count;
  for (int i = 0; i < block.path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(block.path.ray, i), load_hit<F>(block.path.hit, i));
    const Vec3<F> to_light = light_position - vertex.position;
    const F inv_distance_sq = F(1) / length_sq(to_light);
    const F cosine = dot(vertex.ns, to_light) * sqrt(inv_distance_sq);
    const F scale = cosine * inv_distance_sq * F(0.25f * inv_pi * inv_pi);
    const Vec3<F> origin = vertex.origin_of_ray(to_light);
    store_lanes(block.shadow.unshadowed, i,
                Color<F>{F(light.energy.r) * scale, F(light.energy.g) * scale, F(light.energy.b) * scale});
    // Not "greater than 0": a NaN must reach the sum, where it is reported.
    store_mask<F>(&block.shadow.is_needed[i], mask_and(vertex.is_surface, mask_not(cosine <= F(0))));
    store_lanes(block.shadow.origin, i, origin);
    store_lanes(&block.shadow.light[i], Int<F>(-1));
    store_lanes(block.shadow.along, i, light_position - origin);
  }
  block.clock.finish(Stage::light_samples);
}

/// Each sample: what the light gives to what the camera sees, as if that were diffuse with albedo 1.
template <class F>
void simple(const Scene& scene, SampleBlock& block, const SimpleLight& light) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block, Coherence::coherent);
  sample_simple_light<F>(scene, block, light);
  keep_shadow_rays_in_order(block);
  add_unshadowed<F>(scene, block, 0, Coherence::coherent);
}

}  // namespace etendue

// The shading normal as a colour: whether meshes and transforms are read rightly, at a glance.
#pragma once

#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/hit_stage.h"
#include "integrator/vertex.h"

namespace etendue {

/// Each sample: (|x|, |y|, |z|) of the shading normal of what the camera sees, in the world; black where that
/// is nothing.
template <class F>
void normals(const Scene& scene, SampleBlock& block) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block, Coherence::coherent);
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(block.path.ray, i), load_hit<F>(block.path.hit, i));
    add_radiance<F>(block, i, vertex.is_surface, {abs(vertex.ns.x), abs(vertex.ns.y), abs(vertex.ns.z)});
  }
}

}  // namespace etendue

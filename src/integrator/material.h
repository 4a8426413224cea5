// The BSDF as a colour, without any light: Tuebingen's way to look at textures.
#pragma once

#include "base/frame.h"
#include "bsdf/bsdf.h"
#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/hit_stage.h"
#include "integrator/vertex.h"

namespace etendue {

/// Each sample: f(wo, wi) (1/sr) of what the camera sees, wo towards the camera and wi along the shading
/// normal; black where that is nothing.
template <class F>
void material(const Scene& scene, SampleBlock& block) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block, Coherence::coherent);
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(block.path.ray, i), load_hit<F>(block.path.hit, i));
    const Vec3<F> wo_local = Frame<F>(vertex.ns).local_from_world(vertex.wo), wi_local{F(0), F(0), F(1)};
    for_each_material<F>(scene.materials, vertex.material, vertex.uv, vertex.is_surface,
                         [&](const auto& bsdf, const Mask<F>& lanes) {
                           add_radiance<F>(block, i, lanes, bsdf.eval(wo_local, wi_local));
                         });
  }
}

}  // namespace etendue

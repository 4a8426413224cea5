// The BSDF stages: sample a direction from the BSDF, cast the ray, add the light that it meets.
#pragma once

#include "base/frame.h"
#include "bsdf/bsdf.h"
#include "integrator/camera_stage.h"
#include "integrator/light_sampling.h"
#include "integrator/mis_weights.h"
#include "integrator/sample_block.h"
#include "integrator/surface_point.h"
#include "integrator/surface_stage.h"

#include <limits>

namespace etendue {

/// For each sample: a direction from the BSDF at its surface, the ray along it, and its throughput f cos /
/// pdf.
template <class F>
void sample_bsdf(const Scene& scene, SampleBlock& block) {
  for (int i = 0; i < block.padded_count; i += lane_count_v<F>) {
    const SurfacePoint<F> surface(scene, block.camera_ray, block.camera_hit, i);
    if (!any(surface.is_there)) {
      store_lanes(&block.bsdf_ray.is_active[i], Int<F>(0));
      continue;
    }
    const Vec2<F> u_bsdf = to_unit_floats<F>(sample_bits<F>(scene, block, i, dimension::bsdf));
    const Frame<F> frame(surface.ns);
    const Vec3<F> wo_local = frame.local_from_world(surface.wo);
    BsdfSample<F> sample{{F(0), F(0), F(1)}, {F(0), F(0), F(0)}, F(0)};
    for_each_material<F>(scene.materials, surface.material, Vec2<F>{F(0), F(0)}, surface.is_there,
                         [&](const auto& bsdf, const Mask<F>& lanes) {
                           sample = select(lanes, bsdf.sample_(wo_local, u_bsdf), sample);
                         });
    const Vec3<F> wi = frame.world_from_local(sample.wi_local);
    store_mask<F>(&block.bsdf_ray.is_active[i],
                  mask_and(surface.is_there, sample.pdf_solid_angle > F(0), mask_not(is_black(sample.weight)),
                           surface.reflects_towards(wi)));
    store_lanes(block.bsdf_ray.origin, i, surface.offset_origin());
    store_lanes(block.bsdf_ray.direction, i, wi);
    store_lanes(&block.bsdf_ray.t_near[i], F(0));
    store_lanes(&block.bsdf_ray.t_far[i], F(std::numeric_limits<float>::infinity()));
    store_lanes(block.throughput, i, sample.weight);
    store_lanes(&block.pdf_bsdf[i], sample.pdf_solid_angle);
  }
  for (int i = 0; i < block.count; ++i) block.bsdf_rays -= block.bsdf_ray.is_active[i];
  block.clock.finish(Stage::bsdf_samples);
}

/// Casts the BSDF samples' rays and adds the emission of what they hit.
template <class F>
void add_bsdf_hits(const Scene& scene, SampleBlock& block, Combination combination) {
  cast_rays<F>(scene, block.bsdf_ray, block.bsdf_hit, block.padded_count, Coherence::incoherent);
  for_each_emission<F>(
      scene, block.bsdf_ray, block.bsdf_hit, block.padded_count,
      [&](int i, const Mask<F>& lanes, const Int<F>& light, const Color<F>& emitted, const Vec3<F>& ng) {
        F weight = mis_weight(combination, F(1), F(1));
        if (needs_both_pdfs(combination)) {
          const SurfacePoint<F> surface(scene, block.camera_ray, block.camera_hit, i);
          const Vec3<F> wi = load_lanes<F>(block.bsdf_ray.direction, i);
          const Vec3<F> hit =
              load_lanes<F>(block.bsdf_ray.origin, i) + wi * load_lanes<F>(&block.bsdf_hit.t[i]);
          const F pdf_light = light_pdf_solid_angle<F>(scene, light, surface.position, hit, ng, wi, lanes);
          weight = mis_weight(combination, select(lanes, load_lanes<F>(&block.pdf_bsdf[i]), F(1)), pdf_light);
        }
        const Color<F> direct = load_lanes<F>(block.throughput, i) * emitted * weight;
        const Color<F> before = load_lanes<F>(block.radiance, i);
        store_lanes(block.radiance, i, before + select(lanes, direct, black<F>()));
      });
  block.clock.finish(Stage::bsdf_rays);
}

/// Both of the above, as integrators that sample BSDFs use it.
template <class F>
void add_bsdf_samples(const Scene& scene, SampleBlock& block, Combination combination) {
  sample_bsdf<F>(scene, block);
  add_bsdf_hits<F>(scene, block, combination);
}

}  // namespace etendue

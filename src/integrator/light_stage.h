// The light stages: sample the lights, add what nothing hides.
#pragma once

#include "base/frame.h"
#include "integrator/aiming_stage.h"
#include "integrator/camera_stage.h"
#include "integrator/light_sampling.h"
#include "integrator/path_rules.h"
#include "integrator/sample_block.h"
#include "integrator/vertex.h"

#include <algorithm>

namespace etendue {

/// Which of the light samples of a vertex: number `number` of PathRules::light_samples, or of light `number`.
template <class F>
LightSample<F> sample_lights(const Scene& scene, const PathRules& rules, const PathColumns& path,
                             const Vertex<F>& vertex, int i, int vertex_number, int number) {
  const std::uint32_t pair = dimension::at_vertex(dimension::light, vertex_number);
  if (rules.is_every_light) {
    const Vec2<UInt<F>> u_light = sample_bits<F>(scene, path, i, pair, number, scene.lights.count());
    return sample_chosen_light<F>(scene, {.light = Int<F>(number), .u_left = u_light.x, .pmf = F(1)},
                                  vertex.position, u_light.y, vertex.is_there);
  }
  const Vec2<UInt<F>> u_light = sample_bits<F>(scene, path, i, pair, number, rules.light_samples);
  return sample_lights<F>(scene, vertex.position, u_light, vertex.is_there);
}

/// For each path: a light sample, its shadow segment, and what it adds to the radiance where it is visible.
template <class F>
[[gnu::noinline]] void sample_lights(const Scene& scene, SampleBlock& block, const PathRules& rules,
                                     int vertex_number, int number) {
  const PathColumns& path = block.path;
  const F n_light(float(rules.light_samples)), n_bsdf(float(rules.bsdf_samples));
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, path.ray, path.hit, i);
    if (!any(vertex.is_there)) {
      store_lanes(&block.shadow_is_needed[i], Int<F>(0));
      continue;
    }
    const LightSample<F> sample = sample_lights<F>(scene, rules, path, vertex, i, vertex_number, number);

    const Frame<F> frame(vertex.ns);
    const Vec3<F> wo_local = frame.local_from_world(vertex.wo), wi_local = frame.local_from_world(sample.wi);
    const Mask<F> is_lit = mask_and(sample.is_there, vertex.is_consistent(wo_local.z, wi_local.z, sample.wi));
    const F cosine = vertex.foreshortening(wi_local.z);
    Color<F> scattered = black<F>();
    for_each_scatterer<F>(scene, vertex, is_lit, [&](const auto& bsdf, const Mask<F>& lanes) {
      F weight = F(1);
      if (needs_both_pdfs(rules.direct_light))
        weight = mis_weight(rules.direct_light, select(lanes, sample.pdf_solid_angle(), F(1)) * n_light,
                            bsdf.pdf_solid_angle(wo_local, wi_local) * n_bsdf);
      else if (rules.direct_light == DirectLight::half)
        weight = mis_weight(rules.direct_light, sample.pdf_solid_angle(), F(0));
      scattered = select(lanes, bsdf.eval(wo_local, wi_local) * sample.radiance_over_pdf * (cosine * weight),
                         scattered);
    });
    if (rules.light_samples > 1) scattered = scattered * F(1 / float(rules.light_samples));
    const Vec3<F> origin = vertex.offset_origin(sample.wi);
    const Vec3<F> along = sample.end - origin;
    if (scene.medium) scattered = scattered * scene.medium->transmittance(origin, along);

    store_lanes(block.unshadowed, i, scattered * load_lanes<F>(path.throughput, i));
    // Not "greater than 0": a NaN must reach the sum, where it is reported.
    store_mask<F>(&block.shadow_is_needed[i], mask_and(is_lit, mask_not(is_black(scattered))));
    store_lanes(block.shadow_origin, i, origin);
    store_lanes(block.shadow_direction, i, along);
    store_lanes(&block.aim[i], sample.light * Int<F>(light_pieces) + sample.piece);
  }
  block.clock.finish(Stage::light_samples);
}

/// Casts the shadow rays in their order and adds the light samples that nothing hides.
template <class F>
[[gnu::noinline]] void add_unshadowed(const Scene& scene, SampleBlock& block, Coherence coherence) {
  int padded = block.shadow_count;
  while (padded % lane_count_v<F> != 0) block.order[std::size_t(padded++)] = -1;
  const SegmentSpan segments{block.shadow_origin.x.data(),
                             block.shadow_origin.y.data(),
                             block.shadow_origin.z.data(),
                             block.shadow_direction.x.data(),
                             block.shadow_direction.y.data(),
                             block.shadow_direction.z.data(),
                             block.order.data(),
                             padded,
                             shadow_segment_end};
  std::fill_n(block.shadow_is_free.begin(), block.path.padded_count, 0);
  scene.rays.unoccluded(segments, block.shadow_is_free.data(), lane_count_v<F>, coherence);
  for (int i = 0; i < block.path.padded_count; i += lane_count_v<F>) {
    const Mask<F> is_free = load_mask<F>(&block.shadow_is_free[i]);
    if (any(is_free)) add_radiance<F>(block, i, is_free, load_lanes<F>(block.unshadowed, i));
  }
  block.counts.shadow_rays += block.shadow_count;
  block.clock.finish(Stage::shadow_rays);
}

/// All of the above: the light that comes straight from lights, by samples of the lights.
template <class F>
void add_light_samples(const Scene& scene, SampleBlock& block, const PathRules& rules, int vertex,
                       bool is_reordering) {
  const int samples = rules.is_every_light ? scene.lights.count() : rules.light_samples;
  for (int number = 0; number < samples; ++number) {
    sample_lights<F>(scene, block, rules, vertex, number);
    if (is_reordering)
      aim_shadow_rays(scene, block);
    else
      keep_shadow_rays_in_order(block);
    const bool is_coherent = is_reordering && scene.lights.are_aimed_packets_coherent();
    add_unshadowed<F>(scene, block, is_coherent ? Coherence::coherent : Coherence::incoherent);
  }
}

}  // namespace etendue

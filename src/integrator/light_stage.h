// The light stages: sample the lights, add what nothing hides.
#pragma once

#include "integrator/aiming_stage.h"
#include "integrator/block_receiver.h"
#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/direct_light.h"
#include "integrator/resampling.h"

#include <algorithm>

namespace etendue {

/// Which of the samples of a vertex: of several of the lights, and of the light sampler's passes.
struct LightSampleNumber {
  int vertex = 0, number = 0;
  std::int32_t pass = 0;
};

/// One light sample of the paths i, i + 1 ...: one candidate, or one of several. The candidates of all light
/// samples follow one another in one sequence over the samples of the pixel; each pass has its own, as every
/// second or third point of one is badly distributed.
template <class F>
DirectLightSample<F> light_sample_of(const Scene& scene, const LightSampler& light_sampler,
                                     const PathRules& rules, const SampleBlock& block, int i,
                                     const Vertex<F>& vertex, const LightSampleNumber& which) {
  using U = UInt<F>;
  const Receiver<F> receiver = receiver_at<F>(scene, block, i, vertex, which.vertex);
  const int light_samples = rules.light_count(which.vertex), few = rules.candidates(which.vertex),
            many = rules.glossy_candidates(which.vertex);
  Int<F> candidates(many);
  Mask<F> is_glossy = vertex.is_there;
  if (few != many) {
    is_glossy = mask_not(vertex.leaves_direct_light_to_lights(scene));
    candidates = select(is_glossy, candidates, Int<F>(few));
  }
  const int most = any(mask_and(vertex.is_there, is_glossy)) ? many : few;
  const F share = F(1) / (to_float(candidates) * F(float(light_samples)));
  const U first = (load_lanes<U>(&block.path.index[i]) * U(std::uint32_t(light_samples)) +
                   U(std::uint32_t(which.number))) *
                  as_uint(candidates);
  const std::uint32_t vertex_number = std::uint32_t(which.vertex);
  const auto candidate = [&](int k, const Mask<F>& lanes) {
    const Vec2<U> u_light =
        sample_bits_at<F>(scene, block.path, i, dimension::at_vertex(dimension::light, vertex_number),
                          first + U(std::uint32_t(k)), which.pass);
    return sample_direct_light<F>(scene, light_sampler, rules, which.vertex, share, vertex, receiver, u_light,
                                  which.pass, lanes);
  };
  if (most == 1) return candidate(0, vertex.is_there);
  const Vec2<U> u_selection =
      sample_bits<F>(scene, block.path, i, dimension::at_vertex(dimension::selection, vertex_number),
                     {which.number, light_samples, which.pass});
  ResampledLight<F> light(to_unit_float(u_selection.x));
  for (int k = 0; k < most; ++k)
    light.offer(candidate(k, mask_and(vertex.is_there, less(Int<F>(k), candidates))));
  return light.take();
}

/// For each path: a light sample, its shadow segment, and what it adds to the radiance where it is visible.
template <class F>
[[gnu::noinline]] void sample_lights(const Scene& scene, const LightSampler& light_sampler,
                                     SampleBlock& block, const PathRules& rules,
                                     const LightSampleNumber& which) {
  const PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(path.ray, i), load_hit<F>(path.hit, i));
    if (!any(vertex.is_there)) {
      store_lanes(&block.shadow_is_needed[i], Int<F>(0));
      continue;
    }
    const DirectLightSample<F> sample =
        light_sample_of<F>(scene, light_sampler, rules, block, i, vertex, which);
    store_lanes(block.unshadowed, i, sample.unshadowed * load_lanes<F>(path.throughput, i));
    store_mask<F>(&block.shadow_is_needed[i], sample.needs_shadow_ray);
    store_lanes(block.shadow_origin, i, sample.origin);
    store_lanes(block.shadow_direction, i, sample.along);
    store_lanes(&block.shadow_light[i], sample.light.light);
    store_lanes(&block.shadow_piece[i], sample.light.piece);
  }
  block.clock.finish(Stage::light_samples);
}

/// Casts the shadow rays in their order and adds the light samples that nothing hides.
template <class F>
[[gnu::noinline]] void add_unshadowed(const Scene& scene, SampleBlock& block, int vertex,
                                      Coherence coherence) {
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
    if (any(is_free))
      add_contribution<F>(block, i, is_free, load_lanes<F>(block.unshadowed, i),
                          {load_lanes<Int<F>>(&block.shadow_light[i]), Technique::light, vertex + 1});
  }
  block.counts.shadow_rays += block.shadow_count;
  block.clock.finish(Stage::shadow_rays);
}

/// All of the above: the light that comes straight from lights, by samples of the lights.
template <class F>
void add_light_samples(const Scene& scene, const LightSampler& light_sampler, SampleBlock& block,
                       const PathRules& rules, int vertex, bool is_reordering) {
  const std::int32_t lights_a_pass = light_sampler.passes() > 1 ? 1 : scene.lights.count();
  const bool is_aimed = is_reordering && is_worth_aiming(block, vertex, lights_a_pass);
  for (int number = 0; number < rules.light_count(vertex); ++number)
    for (std::int32_t pass = 0; pass < light_sampler.passes(); ++pass) {
      sample_lights<F>(scene, light_sampler, block, rules, {vertex, number, pass});
      if (is_aimed)
        aim_shadow_rays(scene, block);
      else
        keep_shadow_rays_in_order(block);
      const bool is_coherent = is_aimed && are_aimed_packets_coherent(scene.lights);
      add_unshadowed<F>(scene, block, vertex, is_coherent ? Coherence::coherent : Coherence::incoherent);
      if (block.watcher) block.watcher->on_light_sample(block, vertex, number, pass);
    }
}

}  // namespace etendue

// The light stages: sample the lights, add what nothing hides.
#pragma once

#include "integrator/aiming_stage.h"
#include "integrator/block_receiver.h"
#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/direct_light.h"
#include "integrator/resampling.h"

#include <algorithm>
#include <array>
#include <span>

namespace etendue {

/// One light sample of the paths i, i + 1 ...: one of `candidates` that are there. Those of all light
/// samples follow one another in one sequence over the samples of the pixel; each pass has its own, as every
/// second or third point of one is badly distributed.
template <class F>
DirectLightSample<F> light_sample_of(const Scene& scene, const LightSampler& light_sampler,
                                     const PathRules& rules, const SampleBlock& block, int i,
                                     const Vertex<F>& vertex, const Receiver<F>& receiver,
                                     const Int<F>& candidates, const LightSampleNumber& which) {
  using U = UInt<F>;
  const int light_samples = rules.light_count(which.vertex), few = rules.candidates(which.vertex),
            many = rules.glossy_candidates(which.vertex);
  const Mask<F> is_many = mask_and(vertex.is_there, equal(candidates, Int<F>(many)));
  const int most = any(is_many) ? many : few;
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

/// For each path: the light samples `numbers`, the shadow segment of each, and what it adds to the radiance
/// where it is visible.
template <class F>
[[gnu::noinline]] void sample_lights(const Scene& scene, const LightSampler& light_sampler,
                                     SampleBlock& block, const PathRules& rules,
                                     std::span<const LightSampleNumber> numbers) {
  const PathColumns& path = block.path;
  ShadowRays& shadow = block.shadow;
  shadow.samples = int(numbers.size());
  shadow.stride = path.padded_count;
  const int vertex_number = numbers.front().vertex;
  F drawn(0);
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(path.ray, i), load_hit<F>(path.hit, i));
    if (!any(vertex.is_there)) {
      for (int k = 0; k < shadow.samples; ++k) store_lanes(&shadow.is_needed[shadow.row(k, i)], Int<F>(0));
      continue;
    }
    const Receiver<F> receiver = receiver_at<F>(scene, block, i, vertex, vertex_number);
    const Color<F> throughput = load_lanes<F>(path.throughput, i);
    const Colorf* alpha = rules.alpha(vertex_number);
    const Int<F> candidates = candidates_of<F>(scene, rules, vertex_number, vertex);
    drawn = drawn + select(vertex.is_there, to_float(candidates), F(0));
    for (int k = 0; k < shadow.samples; ++k) {
      const DirectLightSample<F> sample = light_sample_of<F>(scene, light_sampler, rules, block, i, vertex,
                                                             receiver, candidates, numbers[std::size_t(k)]);
      const int row = shadow.row(k, i);
      Color<F> unshadowed = sample.unshadowed * throughput;
      if (alpha) unshadowed = unshadowed + control_variate(*alpha, sample.control);
      store_lanes(shadow.unshadowed, row, unshadowed);
      store_mask<F>(&shadow.is_needed[row], sample.needs_shadow_ray);
      store_lanes(shadow.origin, row, sample.origin);
      store_lanes(shadow.along, row, sample.along);
      store_lanes(&shadow.light[row], sample.light.light);
      store_lanes(&shadow.aim[row], sample.aim);
    }
  }
  alignas(64) std::array<float, lane_count_v<F>> of_lanes;
  store_lanes(of_lanes.data(), drawn);
  for (const float of_lane : of_lanes) block.counts.candidates += std::int64_t(of_lane) * shadow.samples;
  block.clock.finish(Stage::light_samples);
}

/// Casts the shadow rays in their order and adds the light samples that nothing hides.
template <class F>
[[gnu::noinline]] void add_unshadowed(const Scene& scene, SampleBlock& block, int vertex,
                                      Coherence coherence) {
  ShadowRays& shadow = block.shadow;
  int padded = shadow.count;
  while (padded % lane_count_v<F> != 0) shadow.order[std::size_t(padded++)] = -1;
  const SegmentSpan segments{
      shadow.origin.x.data(), shadow.origin.y.data(), shadow.origin.z.data(), shadow.along.x.data(),
      shadow.along.y.data(),  shadow.along.z.data(),  shadow.order.data(),    padded,
      shadow_segment_end};
  std::fill_n(shadow.is_free.begin(), shadow.rows(), 0);
  scene.rays.unoccluded(segments, shadow.is_free.data(), lane_count_v<F>, coherence);
  for (int k = 0; k < shadow.samples; ++k)
    for (int i = 0; i < block.path.padded_count; i += lane_count_v<F>) {
      const int row = shadow.row(k, i);
      const Mask<F> is_free = load_mask<F>(&shadow.is_free[row]);
      if (any(is_free))
        add_contribution<F>(block, i, is_free, load_lanes<F>(shadow.unshadowed, row),
                            {load_lanes<Int<F>>(&shadow.light[row]), Technique::light, vertex + 1});
    }
  block.counts.shadow_rays += shadow.count;
  block.clock.finish(Stage::shadow_rays);
}

/// All of the above: the light that comes straight from lights, by samples of the lights.
template <class F>
void add_light_samples(const Scene& scene, const LightSampler& light_sampler, SampleBlock& block,
                       const PathRules& rules, int vertex, bool is_reordering) {
  const std::int32_t passes = light_sampler.passes();
  const std::int64_t samples = std::int64_t(rules.light_count(vertex)) * passes;
  for (std::int64_t first = 0; first < samples; first += ShadowRays::most_samples) {
    std::array<LightSampleNumber, ShadowRays::most_samples> numbers;
    const int count = int(std::min<std::int64_t>(samples - first, ShadowRays::most_samples));
    for (int k = 0; k < count; ++k)
      numbers[std::size_t(k)] = {vertex, int((first + k) / passes), std::int32_t((first + k) % passes)};
    sample_lights<F>(scene, light_sampler, block, rules, std::span(numbers).first(std::size_t(count)));
    // Each pass goes to one light, and neighbours in the light tree are near each other.
    const bool are_lights_near = passes > 1 || light_sampler.tree();
    const bool is_aimed = is_reordering && is_worth_aiming(block, vertex, passes > 1 ? 1 : count,
                                                           are_lights_near ? 1 : scene.lights.count());
    if (is_aimed)
      aim_shadow_rays(block, light_sampler.ranks());
    else
      keep_shadow_rays_in_order(block);
    const bool is_coherent = is_aimed && are_aimed_packets_coherent(scene.lights);
    add_unshadowed<F>(scene, block, vertex, is_coherent ? Coherence::coherent : Coherence::incoherent);
    if (block.watcher)
      for (int k = 0; k < count; ++k) block.watcher->on_light_sample(block, numbers[std::size_t(k)], k);
  }
}

}  // namespace etendue

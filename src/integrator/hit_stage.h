// What rays hit, what becomes of them in a medium on the way, and the light that arrives along them.
#pragma once

#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/hit_on_light.h"
#include "integrator/vertex.h"
#include "integrator/weights.h"
#include "lightsampler/light_sampler.h"
#include "scene/scene.h"

namespace etendue {

/// Casts the rays that arrive at the next vertex.
template <class F>
void closest_hits(const Scene& scene, SampleBlock& block, Coherence coherence) {
  scene.rays.closest_hits(span_of(block.path.ray, block.path.padded_count), span_of(block.path.hit),
                          lane_count_v<F>, coherence);
  block.counts.paths += block.path.count;
  block.counts.lanes += (block.path.count + lane_count_v<F> - 1) / lane_count_v<F> * lane_count_v<F>;
  block.clock.finish(Stage::closest_hits);
}

/// Of the rays that pass through the medium, some scatter before they hit anything.
template <class F>
[[gnu::noinline]] void fly_through_medium(const Scene& scene, SampleBlock& block, int vertex) {
  PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const F u_flight =
        to_unit_float(sample_bits<F>(scene, path, i, dimension::at_vertex(dimension::choice, vertex)).y);
    const auto flight = scene.medium->sample_flight<F>(
        load_lanes<F>(path.ray.origin, i), load_lanes<F>(path.ray.direction, i),
        load_lanes<F>(&path.ray.t_near[i]), load_lanes<F>(&path.hit.t[i]), u_flight);
    const Mask<F> is_scattered = mask_and(flight.is_scattered, load_mask<F>(&path.ray.is_active[i]));
    store_lanes(path.throughput, i, load_lanes<F>(path.throughput, i) * flight.weight);
    store_lanes(&path.hit.t[i], select(is_scattered, flight.t, load_lanes<F>(&path.hit.t[i])));
    store_lanes(&path.hit.geometry[i],
                select(is_scattered, Int<F>(in_medium), load_lanes<Int<F>>(&path.hit.geometry[i])));
  }
  block.clock.finish(Stage::medium);
}

/// How light that rays have met counts, in the lanes that a mask of it says.
template <class F>
struct MetLight {
  F weight;
  F control = F(0);               ///< Of optimal weights.
  const Colorf* alpha = nullptr;  ///< Their coefficient; null: there is no control variate.

  /// \param weighted the light, with the path's throughput and the weight
  Color<F> controlled(const Color<F>& weighted) const {
    if (!alpha) return weighted;
    return weighted + select(is_black(weighted), black<F>(), control_variate(*alpha, control));
  }
};

/// Light that the rays i, i + 1 ... have met at a vertex, and whose density (1/sr) by one light sample
/// `pdf_light(receiver)` gives.
template <class F, class Function>
MetLight<F> met_light(const PathRules& rules, const PathColumns& path, int i, int vertex, const Mask<F>& m,
                      Function&& pdf_light) {
  MetLight<F> met{.weight = F(1), .alpha = vertex > 0 ? rules.alpha(vertex - 1) : nullptr};
  F pdf = load_lanes<F>(&path.pdf[i]);
  if (vertex > 0) pdf = pdf * F(float(rules.bsdf_samples(vertex - 1)));
  met.weight = met_light_weight<F>(rules, pdf, m, [&] {
    const F other = pdf_light(load_receiver<F>(path.receiver, i)) * F(float(rules.light_draws(vertex - 1)));
    if (met.alpha) met.control = met_light_control(pdf, other);
    return other;
  });
  return met;
}

/// Adds the emission of the lights that rays have hit on a side that shines.
template <class F>
[[gnu::noinline]] void add_emission(const Scene& scene, const LightSampler& light_sampler, SampleBlock& block,
                                    const PathRules& rules, int vertex) {
  const PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Hit<F> hit = load_hit<F>(path.hit, i);
    const Ray<F> ray = load_ray<F>(path.ray, i);
    const HitOnLight<F> on_light(scene, ray, hit);
    Mask<F> is_front = on_light.is_there;
    if (vertex == 0 && block.has_outlines)  // There rays of their own have found it.
      is_front = mask_and(is_front, mask_not(load_mask<F>(&block.is_at_outline[i])));
    if (!any(is_front)) continue;
    const Int<F> light = on_light.light;
    const Vec3<F> position = ray.origin + ray.direction * hit.t;
    const MetLight<F> met = met_light<F>(rules, path, i, vertex, is_front, [&](const Receiver<F>& receiver) {
      const LightTechnique technique = rules.light_samples()->technique;
      const Int<F> facet = light_sampler.chooses_facets() || technique != LightTechnique::area
                               ? scene.lights.facet_at<F>(light, hit.primitive, position, is_front)
                               : Int<F>(whole_light);
      const F pmf = light_sampler.pmf<F>(receiver, select(is_front, light, Int<F>(0)), facet);
      const LightHit<F> hit_on_light{
          position, on_light.ng, ray.direction, facet, light_sampler.chooses_facets(), technique};
      return scene.lights.pdf_solid_angle<F>(light, pmf, receiver, hit_on_light, is_front);
    });
    add_contribution<F>(
        block, i, is_front,
        met.controlled(load_lanes<F>(path.throughput, i) * on_light.radiance(scene, hit) * met.weight),
        {light, Technique::bsdf, vertex});
  }
  block.clock.finish(Stage::emission);
}

/// Adds the light from infinity that reaches rays which have left the scene.
template <class F>
[[gnu::noinline]] void add_environment(const Scene& scene, const LightSampler& light_sampler,
                                       SampleBlock& block, const PathRules& rules, int vertex) {
  const PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Mask<F> is_outside = mask_and(equal(load_lanes<Int<F>>(&path.hit.geometry[i]), Int<F>(-1)),
                                        load_mask<F>(&path.ray.is_active[i]));
    if (!any(is_outside)) continue;
    const Vec3<F> direction = load_lanes<F>(path.ray.direction, i);
    for (int k = 0; k < scene.lights.infinite_count(); ++k) {
      const Int<F> light(scene.lights.infinite_light(k));
      const MetLight<F> met =
          met_light<F>(rules, path, i, vertex, is_outside, [&](const Receiver<F>& receiver) {
            return light_sampler.pmf<F>(receiver, light, Int<F>(0)) *
                   scene.lights.infinite_pdf_solid_angle<F>(k, receiver, direction, is_outside,
                                                            rules.light_samples()->technique);
          });
      add_contribution<F>(
          block, i, is_outside,
          met.controlled(load_lanes<F>(path.throughput, i) *
                         (scene.lights.infinite_radiance<F>(k, direction, is_outside) * met.weight)),
          {light, Technique::bsdf, vertex});
    }
  }
  block.clock.finish(Stage::emission);
}

}  // namespace etendue

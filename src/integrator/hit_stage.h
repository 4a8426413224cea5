// What rays hit, what becomes of them in a medium on the way, and the light that arrives along them.
#pragma once

#include "integrator/light_sampling.h"
#include "integrator/path_rules.h"
#include "integrator/sample_block.h"
#include "integrator/vertex.h"
#include "light/light.h"
#include "scene/scene.h"

namespace etendue {

/// Casts the rays that arrive at the next vertex.
template <class F>
void closest_hits(const Scene& scene, SampleBlock& block, Coherence coherence) {
  const RayColumns& rays = block.path.ray;
  HitColumns& hits = block.path.hit;
  scene.rays.closest_hits(
      {rays.origin.x.data(), rays.origin.y.data(), rays.origin.z.data(), rays.direction.x.data(),
       rays.direction.y.data(), rays.direction.z.data(), rays.t_near.data(), rays.t_far.data(),
       rays.is_active.data(), block.path.padded_count},
      {hits.t.data(), hits.ng.x.data(), hits.ng.y.data(), hits.ng.z.data(), hits.u.data(), hits.v.data(),
       hits.geometry.data(), hits.primitive.data()},
      lane_count_v<F>, coherence);
  block.counts.paths += block.path.count;
  block.counts.lanes += (block.path.count + lane_count_v<F> - 1) / lane_count_v<F> * lane_count_v<F>;
  block.clock.finish(Stage::closest_hits);
}

/// Of the rays that pass through the medium, some scatter before they hit anything. `number`: of the BSDF
/// sample along which they come.
template <class F>
[[gnu::noinline]] void fly_through_medium(const Scene& scene, SampleBlock& block, const PathRules& rules,
                                          int vertex, int number) {
  PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const int count = vertex == 0 ? 1 : rules.bsdf_samples;
    const F u_flight = to_unit_float(
        sample_bits<F>(scene, path, i, dimension::at_vertex(dimension::choice, vertex), number, count).y);
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

/// The weight of light that a ray has met rather than a light sample; `f()` gives the density (1/sr) with
/// which light samples find its direction.
template <class F, class Function>
F met_light_weight(const PathRules& rules, const PathColumns& path, int i, const Mask<F>& m, Function&& f) {
  const F pdf = load_lanes<F>(&path.pdf[i]);
  const F infinity(std::numeric_limits<float>::infinity());
  if (rules.direct_light == DirectLight::lights) return select(pdf < infinity, F(0), F(1));
  if (!needs_both_pdfs(rules.direct_light)) return mis_weight(rules.direct_light, pdf, F(0));
  if (!any(mask_and(m, pdf < infinity))) return F(1);
  return mis_weight(rules.direct_light, select(m, pdf, F(1)) * F(float(rules.bsdf_samples)),
                    f() * F(float(rules.light_samples)));
}

/// Adds the emission of the lights that rays have hit from the front.
template <class F>
[[gnu::noinline]] void add_emission(const Scene& scene, SampleBlock& block, const PathRules& rules) {
  const PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Int<F> geometry = load_lanes<Int<F>>(&path.hit.geometry[i]);
    const Mask<F> is_hit = less(Int<F>(-1), geometry);
    const Int<F> light = gather(scene.geometry.light.data(), select(is_hit, geometry, Int<F>(0)));
    const Mask<F> is_light = mask_and(is_hit, less(Int<F>(-1), light));
    if (!any(is_light)) continue;
    const Vec3<F> ng = normalize(load_lanes<F>(path.hit.ng, i));
    const Vec3<F> direction = load_lanes<F>(path.ray.direction, i);
    const Mask<F> is_front = mask_and(is_light, dot(ng, direction) < F(0));
    if (!any(is_front)) continue;
    const F weight = met_light_weight<F>(rules, path, i, is_front, [&] {
      const Vec3<F> hit = load_lanes<F>(path.ray.origin, i) + direction * load_lanes<F>(&path.hit.t[i]);
      return light_pdf_solid_angle<F>(scene, light, load_lanes<F>(path.from, i), hit, ng, direction,
                                      is_front);
    });
    add_radiance<F>(block, i, is_front,
                    load_lanes<F>(path.throughput, i) * scene.lights.radiance<F>(light, is_front) * weight);
  }
  block.clock.finish(Stage::emission);
}

/// Adds the light from infinity that reaches rays which have left the scene.
template <class F>
[[gnu::noinline]] void add_environment(const Scene& scene, SampleBlock& block, const PathRules& rules) {
  const PathColumns& path = block.path;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Mask<F> is_outside = mask_and(equal(load_lanes<Int<F>>(&path.hit.geometry[i]), Int<F>(-1)),
                                        load_mask<F>(&path.ray.is_active[i]));
    if (!any(is_outside)) continue;
    const Vec3<F> direction = load_lanes<F>(path.ray.direction, i);
    Color<F> sum = black<F>();
    for (int light = 0; light < scene.lights.infinite_count(); ++light) {
      const F weight = met_light_weight<F>(rules, path, i, is_outside, [&] {
        return environment_pdf_solid_angle<F>(scene, light, direction, is_outside);
      });
      sum = sum + environment_radiance<F>(scene, light, direction, is_outside) * weight;
    }
    add_radiance<F>(block, i, is_outside, load_lanes<F>(path.throughput, i) * sum);
  }
  block.clock.finish(Stage::emission);
}

}  // namespace etendue

// One sample of the lights at a vertex: choose a light, sample it, scatter its light, weigh it.
#pragma once

#include "base/frame.h"
#include "integrator/vertex.h"
#include "integrator/weights.h"
#include "lightsampler/light_sampler.h"

namespace etendue {

template <class F>
struct DirectLightSample {
  LightSample<F> light;
  Vec3<F> origin, along;     ///< The shadow segment: where it starts, and from there to the light (m).
  Color<F> unshadowed;       ///< Radiance towards `wo`, weighted, where nothing hides the light.
  F control = F(0);          ///< Of optimal weights, in units of ByBoth::alpha.
  Int<F> aim;                ///< Rank and piece of the light: near ones are near each other.
  Mask<F> needs_shadow_ray;  ///< Elsewhere it adds nothing, hidden or not.
};

template <class F>
DirectLightSample<F> select(const Mask<F>& m, const DirectLightSample<F>& a, const DirectLightSample<F>& b) {
  return {select(m, a.light, b.light),
          select(m, a.origin, b.origin),
          select(m, a.along, b.along),
          select(m, a.unshadowed, b.unshadowed),
          select(m, a.control, b.control),
          select(m, a.aim, b.aim),
          mask_or(mask_and(m, a.needs_shadow_ray), mask_and(mask_not(m), b.needs_shadow_ray))};
}

/// The light that reaches the vertices straight from a light, by one sample of the lights: what course
/// handouts call `sampleLights`, with the BSDF, the cosine and the weight that they leave to `Li`.
/// \param vertex_number which of the path's \param share of this sample among all that are added up
/// \param receiver as lights see the vertex \param u_light chooses the light and places the point
/// \param pass of the light sampler's passes \param lanes that take a sample
template <class F>
DirectLightSample<F> sample_direct_light(const Scene& scene, const LightSampler& light_sampler,
                                         const PathRules& rules, int vertex_number, const F& share,
                                         const Vertex<F>& vertex, const Receiver<F>& receiver,
                                         const Vec2<UInt<F>>& u_light, std::int32_t pass,
                                         const Mask<F>& lanes) {
  // Choose a light.
  const LightChoice<F> choice = light_sampler.choose<F>(receiver, u_light.x, pass);

  // Sample it: a point (`samplePosition`) or a direction, its radiance over its density
  // (`LuminaireQueryRecord`, `pdf`), the geometry term but for the receiver's cosine.
  DirectLightSample<F> sample;
  sample.light = scene.lights.sample<F>(choice.light, choice.pmf, receiver, {choice.u_left, u_light.y},
                                        mask_and(lanes, choice.pmf > F(0)), choice.facet,
                                        rules.light_samples()->technique);

  // Scatter it: BSDF times cosine, on the sides of the surface that agree with its shading normal.
  const Frame<F> frame(vertex.ns);
  const Vec3<F> wo_local = frame.local_from_world(vertex.wo),
                wi_local = frame.local_from_world(sample.light.wi);
  const Mask<F> is_lit =
      mask_and(sample.light.is_there, vertex.is_consistent(wo_local.z, wi_local.z, sample.light.wi));
  const F cosine = vertex.foreshortening(wi_local.z);
  const float light_samples = float(rules.light_draws(vertex_number)),
              bsdf_samples = float(rules.bsdf_samples(vertex_number));
  const Mask<F> is_alone =
      rules.is_shared_only_where_glossy() ? vertex.leaves_direct_light_to_lights(scene) : F(1) < F(0);
  Color<F> scattered = black<F>();
  for_each_scatterer<F>(scene, vertex, is_lit, [&](const auto& bsdf, const Mask<F>& scattering) {
    // Weigh it: against the chance that a BSDF sample finds the same light.
    F weight = light_sample_weight<F>(
        rules, select(scattering, sample.light.pdf_solid_angle, F(1)) * F(light_samples),
        [&] { return bsdf.pdf_solid_angle(wo_local, wi_local) * F(bsdf_samples); });
    if (rules.is_shared_only_where_glossy()) weight = select(is_alone, F(1), weight);
    if (rules.alpha(vertex_number)) {
      const F control = light_sample_control(sample.light.pdf_solid_angle * F(light_samples),
                                             bsdf.pdf_solid_angle(wo_local, wi_local) * F(bsdf_samples));
      sample.control = select(mask_and(scattering, mask_not(is_alone)), control, sample.control);
    }
    const Color<F> f = bsdf.eval(wo_local, wi_local);
    scattered = select(scattering, f * sample.light.radiance_over_pdf * (cosine * weight), scattered);
  });
  scattered = scattered * share;

  // What may hide it: shapes along the shadow segment (`V`), and the medium, which dims it.
  sample.origin = vertex.origin_of_ray(sample.light.wi);
  sample.along = sample.light.end - sample.origin;
  if (scene.medium) scattered = scattered * scene.medium->transmittance(sample.origin, sample.along);
  sample.unshadowed = scattered;
  sample.aim = choice.rank * Int<F>(light_pieces) + sample.light.piece;
  // Not "greater than 0": a NaN must reach the sum, where it is reported.
  sample.needs_shadow_ray = mask_and(is_lit, mask_not(is_black(scattered)));
  return sample;
}

}  // namespace etendue

// One light sample: choose a light, choose a point on it, its radiance over the density of that choice.
#pragma once

#include "light/light.h"
#include "lightsampler/uniform.h"
#include "scene/scene.h"

namespace etendue {

/// A sample of the light that arrives at a reference point, visibility left out.
template <class F>
struct LightSample {
  Vec3<F> end;  ///< Where the shadow segment ends: on the light, world (m).
  Vec3<F> wi;        ///< Unit, from the reference point to the light.
  /// Emitted radiance times cos(theta'') / distance^2 over the density per area; the cosine at the receiver
  /// is left to the caller. 0 where the light faces away.
  Color<F> radiance_over_pdf;
  F pdf_area;           ///< 1/m^2, the probability of the light included.
  F distance_sq;        ///< m^2
  F cos_theta_light;    ///< Between the light's geometric normal and the direction to the reference point.
  Mask<F> is_there;    ///< Elsewhere the light faces away, and there is no sample.
  Int<F> light, piece;  ///< Near samples of one light have near pieces.

  /// The density of `wi` (1/sr) at the reference point; 0: no sample.
  F pdf_solid_angle() const {
    return select(is_there, solid_angle_from_area(pdf_area, distance_sq, cos_theta_light), F(0));
  }
};

/// Area sampling of the lights: uniform choice of a light, a point on it by `sample_position`, the geometry
/// term without the receiver's cosine, and the probability from `pdf_area`. \param u_light one 2-D sample,
/// which chooses the light and places the point
template <class F>
LightSample<F> sample_chosen_light(const Scene& scene, const LightChoice<F>& choice, const Vec3<F>& reference,
                             const UInt<F>& u_y, const Mask<F>& m) {
  const LightPoint<F> point =
      scene.lights.sample_position<F>(scene.geometry, choice.light, reference, {choice.u_left, u_y}, m);

  const Vec3<F> to_light = point.position - reference;
  const F distance_sq = length_sq(to_light);
  const F inv_distance = F(1) / sqrt(distance_sq);
  const Vec3<F> wi = to_light * inv_distance;
  const F cos_theta_light = -dot(point.ng, wi);
  const Mask<F> is_there =
      mask_and(m, cos_theta_light > F(0), dot(point.ns, wi) < F(0), point.pdf_area > F(0));

  const F geometry_term = cos_theta_light * inv_distance * inv_distance;
  const F pdf_area = choice.pmf * point.pdf_area;
  return {.end = point.position,
          .wi = wi,
          .radiance_over_pdf =
              scene.lights.radiance<F>(choice.light, m) * select(is_there, geometry_term / pdf_area, F(0)),
          .pdf_area = pdf_area,
          .distance_sq = distance_sq,
          .cos_theta_light = cos_theta_light,
          .is_there = is_there,
          .light = choice.light,
          .piece = point.piece};
}

template <class F>
LightSample<F> sample_lights(const Scene& scene, const Vec3<F>& reference, const Vec2<UInt<F>>& u_light,
                             const Mask<F>& m) {
  return sample_chosen_light<F>(scene, choose_light_uniformly<F>(scene.lights.count(), u_light.x), reference, u_light.y, m);
}
template <class F>
Color<F> environment_radiance(const Scene&, int, const Vec3<F>&, const Mask<F>&) { return black<F>(); }
template <class F>
F environment_pdf_solid_angle(const Scene&, int, const Vec3<F>&, const Mask<F>&) { return F(0); }

/// The density (1/sr) with which `sample_lights` gives the direction `wi` from `reference`, which meets
/// `light` at `position` with geometric normal `ng`; the probability of the light included.
template <class F>
F light_pdf_solid_angle(const Scene& scene, const Int<F>& light, const Vec3<F>& reference,
                        const Vec3<F>& position, const Vec3<F>& ng, const Vec3<F>& wi, const Mask<F>& m) {
  const F pdf_area = F(uniform_light_pmf(scene.lights.count())) *
                     scene.lights.pdf_area<F>(light, reference, position, ng, m);
  return solid_angle_from_area(pdf_area, length_sq(position - reference), -dot(ng, wi));
}

}  // namespace etendue

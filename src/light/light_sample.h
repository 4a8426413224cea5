// The light that one light sends to a receiver, as it is sampled: visibility and the receiver's cosine left
// out.
#pragma once

#include "base/lane_vec.h"
#include "geometry/geometry.h"
#include "light/light_point.h"

#include <limits>

namespace etendue {

template <class F>
struct LightSample {
  Vec3<F> wi;   ///< Unit, from the reference point to the light.
  Vec3<F> end;  ///< World: where the shadow segment ends: on the light, or beyond all shapes.
  /// Incident radiance over its density per solid angle, the choice of the light included. Of Dirac lights
  /// (point, spot, directional) the finite ratio: intensity / distance^2 or irradiance, over the pmf.
  Color<F> radiance_over_pdf;
  Mask<F> is_there;  ///< Elsewhere there is no sample: the light faces away, is black there, m did not ask.
  Int<F> light;
  Int<F> piece;  ///< 0 .. light_pieces - 1: near samples of one light have near pieces.
  /// The density in the light's own measure, the choice included: 1/m^2 of area lights; 1/sr of lights at
  /// infinity; infinite of Dirac lights.
  F pdf;
  F distance_sq, cos_theta_light;  ///< From area to solid angle; both 1 where `pdf` needs no change.

  /// The density of `wi` (1/sr) at the reference point; 0: no sample; infinite: a Dirac light.
  F pdf_solid_angle() const {
    return select(is_there, solid_angle_from_area(pdf, distance_sq, cos_theta_light), F(0));
  }
};

template <class F>
LightSample<F> no_light_sample() {
  const Vec3<F> zero{F(0), F(0), F(0)};
  return {zero, zero, black<F>(), F(0) > F(1), Int<F>(0), Int<F>(0), F(0), F(1), F(1)};
}

template <class F>
LightSample<F> select(const Mask<F>& m, const LightSample<F>& a, const LightSample<F>& b) {
  return {.wi = select(m, a.wi, b.wi),
          .end = select(m, a.end, b.end),
          .radiance_over_pdf = select(m, a.radiance_over_pdf, b.radiance_over_pdf),
          .is_there = mask_or(mask_and(m, a.is_there), mask_and(mask_not(m), b.is_there)),
          .light = select(m, a.light, b.light),
          .piece = select(m, a.piece, b.piece),
          .pdf = select(m, a.pdf, b.pdf),
          .distance_sq = select(m, a.distance_sq, b.distance_sq),
          .cos_theta_light = select(m, a.cos_theta_light, b.cos_theta_light)};
}

/// A point on an area light as seen from `reference`: radiance x cos(theta_light) / distance^2 / pdf.
/// \param radiance of the light \param pmf with which the light was chosen
template <class F>
LightSample<F> light_sample_at(const LightPoint<F>& point, const Int<F>& light, const Color<F>& radiance,
                               const F& pmf, const Vec3<F>& reference, const Mask<F>& m) {
  const Vec3<F> to_light = point.position - reference;
  const F distance_sq = length_sq(to_light);
  const F inv_distance = F(1) / sqrt(distance_sq);
  const Vec3<F> wi = to_light * inv_distance;
  const F cos_theta_light = -dot(point.ng, wi);
  const Mask<F> is_there =
      mask_and(m, cos_theta_light > F(0), dot(point.ns, wi) < F(0), point.pdf_area > F(0));

  const F geometry_term = cos_theta_light * inv_distance * inv_distance;
  const F pdf_area = pmf * point.pdf_area;
  return {.wi = wi,
          .end = point.position,
          .radiance_over_pdf = radiance * select(is_there, geometry_term / pdf_area, F(0)),
          .is_there = is_there,
          .light = light,
          .piece = point.piece,
          .pdf = pdf_area,
          .distance_sq = distance_sq,
          .cos_theta_light = cos_theta_light};
}

/// A sample of a light that is no surface, before the choice of the light: kinds fill in these.
/// \param arriving incident radiance over density, or the Dirac ratio, per unit of the light's strength
template <class F>
LightSample<F> light_sample_towards(const Vec3<F>& wi, const Vec3<F>& end, const Color<F>& arriving,
                                    const F& pdf_solid_angle, const Mask<F>& is_there,
                                    const Int<F>& piece = Int<F>(0)) {
  return {.wi = wi,
          .end = end,
          .radiance_over_pdf = arriving,
          .is_there = is_there,
          .light = Int<F>(0),
          .piece = piece,
          .pdf = pdf_solid_angle,
          .distance_sq = F(1),
          .cos_theta_light = F(1)};
}

/// The density of what has only one direction.
template <class F>
F dirac_pdf() {
  return F(std::numeric_limits<float>::infinity());
}

/// A point in direction `wi` that is outside of the scene, wherever `reference` is.
template <class F>
Vec3<F> beyond_scene(const Sphere& bounds, const Vec3<F>& reference, const Vec3<F>& wi) {
  const Vec3<F> center{F(bounds.center.x), F(bounds.center.y), F(bounds.center.z)};
  // A shadow segment stops short of its end by 1e-4 of its length.
  constexpr float margin = 1.001f;
  return reference + wi * ((length(reference - center) + F(bounds.radius)) * F(margin));
}

}  // namespace etendue

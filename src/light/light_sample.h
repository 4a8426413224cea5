// What sampling one light gives: a direction from the receiver, with all but the receiver's BSDF and cosine.
#pragma once

#include "base/lane_vec.h"
#include "geometry/geometry.h"
#include "light/light_point.h"
#include "light/receiver.h"
#include "light/technique.h"

#include <cstdint>
#include <limits>

namespace etendue {

/// The facet of a light that is sampled as a whole.
inline constexpr std::int32_t whole_light = -1;

/// What a light is asked for.
template <class F>
struct LightRequest {
  const Sphere& scene_bounds;
  const Receiver<F>& receiver;
  Vec2<UInt<F>> u;      ///< 32-bit fractions, so that choosing among many triangles leaves enough of them.
  Int<F> light, row;    ///< Its id, and its row in the table of its kind.
  Int<F> facet;         ///< Of the light, or whole_light.
  Color<F> strength;    ///< What `Lights::add` was given.
  Mask<F> is_twosided;  ///< Surfaces that shine from their back side too.
  F pmf;                ///< With which light and facet were chosen: densities have it in them.
  Mask<F> lanes;        ///< Those that ask.
  LightTechnique technique = LightTechnique::area;
};

/// Where a ray has met a light.
template <class F>
struct LightHit {
  Vec3<F> position, ng;  ///< World, m; unit, on the side that the ray has met.
  Vec3<F> wi;            ///< Unit, from the receiver.
  Int<F> facet;  ///< Of the light; whole_light where samples neither choose facets nor look at their shape.
  bool is_facet_chosen = false;                     ///< By the samples' pmf.
  LightTechnique technique = LightTechnique::area;  ///< Of the samples.

  /// For a table that has only the lights of these lanes.
  LightHit of(const Mask<F>& lanes) const {
    LightHit hit = *this;
    hit.facet = select(lanes, facet, Int<F>(0));
    return hit;
  }
};

template <class F>
struct LightSample {
  Vec3<F> wi;   ///< Unit, from the receiver to the light.
  Vec3<F> end;  ///< World: where the shadow segment ends: just off the light, or beyond all shapes.
  /// Incident radiance over its density per solid angle, the choice of the light included. Of Dirac lights
  /// (point, spot, directional) the finite ratio: intensity / distance^2 or irradiance, over the pmf.
  Color<F> radiance_over_pdf;
  /// The density of `wi` (1/sr), the choice of the light included; 0: no sample; infinite: a Dirac light.
  F pdf_solid_angle;
  Mask<F> is_there;  ///< Elsewhere there is no sample: the light faces away, is black there, nobody asked.
  Int<F> light;
  Int<F> piece;  ///< 0 .. light_pieces - 1: near samples of one light have near pieces.
};

template <class F>
LightSample<F> no_light_sample() {
  const Vec3<F> zero{F(0), F(0), F(0)};
  return {zero, zero, black<F>(), F(0), F(0) > F(1), Int<F>(0), Int<F>(0)};
}

template <class F>
LightSample<F> select(const Mask<F>& m, const LightSample<F>& a, const LightSample<F>& b) {
  return {.wi = select(m, a.wi, b.wi),
          .end = select(m, a.end, b.end),
          .radiance_over_pdf = select(m, a.radiance_over_pdf, b.radiance_over_pdf),
          .pdf_solid_angle = select(m, a.pdf_solid_angle, b.pdf_solid_angle),
          .is_there = mask_or(mask_and(m, a.is_there), mask_and(mask_not(m), b.is_there)),
          .light = select(m, a.light, b.light),
          .piece = select(m, a.piece, b.piece)};
}

/// A point on an area light as its receiver sees it: radiance x cos(theta_light) / distance^2 / pdf. Of a
/// two-sided light the side that faces the receiver is the front.
template <class F>
LightSample<F> light_sample_at(const LightPoint<F>& point, const LightRequest<F>& request) {
  const Vec3<F> to_light = point.position - request.receiver.position;
  const F distance_sq = length_sq(to_light);
  const F inv_distance = F(1) / sqrt(distance_sq);
  const Vec3<F> wi = to_light * inv_distance;
  const Mask<F> is_turned = mask_and(request.is_twosided, dot(point.ng, wi) > F(0));
  const Vec3<F> ng = select(is_turned, -point.ng, point.ng);
  const F cos_theta_light = -dot(ng, wi);
  const Mask<F> is_there = mask_and(
      request.lanes, is_front_facing(point.position, ng, request.receiver.position), point.pdf_area > F(0));

  const F geometry_term = cos_theta_light * inv_distance * inv_distance;
  const F pdf_area = request.pmf * point.pdf_area;
  return {.wi = wi,
          .end = point.position + ng * (point.clearance + clearance<F>(ng, abs_each(to_light), F(0))),
          .radiance_over_pdf = request.strength * select(is_there, geometry_term / pdf_area, F(0)),
          .pdf_solid_angle =
              select(is_there, solid_angle_from_area(pdf_area, distance_sq, cos_theta_light), F(0)),
          .is_there = is_there,
          .light = request.light,
          .piece = point.piece};
}

/// The density (1/sr) with which a receiver's samples of an area light give the direction of `hit`.
/// \param pdf_area there (1/m^2), the choice of the light included
template <class F>
F pdf_solid_angle_at(const LightHit<F>& hit, const Receiver<F>& receiver, const F& pdf_area) {
  return select(
      is_front_facing(hit.position, hit.ng, receiver.position),
      solid_angle_from_area(pdf_area, length_sq(hit.position - receiver.position), -dot(hit.ng, hit.wi)),
      F(0));
}

/// A sample by its direction: of a light that is no surface, or of one that is not sampled by area.
/// \param arriving incident radiance over density, or the Dirac ratio, per unit of the light's strength
/// \param pdf_solid_angle of the direction, the choice of the light not included
template <class F>
LightSample<F> light_sample_towards(const Vec3<F>& wi, const Vec3<F>& end, const Color<F>& arriving,
                                    const F& pdf_solid_angle, const Mask<F>& is_there,
                                    const LightRequest<F>& request, const Int<F>& piece = Int<F>(0)) {
  return {.wi = wi,
          .end = end,
          .radiance_over_pdf = arriving * request.strength * (F(1) / request.pmf),
          .pdf_solid_angle = select(is_there, pdf_solid_angle * request.pmf, F(0)),
          .is_there = is_there,
          .light = request.light,
          .piece = piece};
}

/// The density of what has only one direction.
template <class F>
F dirac_pdf() {
  return F(std::numeric_limits<float>::infinity());
}

/// A point in direction `wi` that is outside of the scene, wherever the receiver is.
template <class F>
Vec3<F> beyond_scene(const LightRequest<F>& request, const Vec3<F>& wi) {
  const Sphere& bounds = request.scene_bounds;
  const Vec3<F> center{F(bounds.center.x), F(bounds.center.y), F(bounds.center.z)};
  constexpr float margin = 1.001f;
  return request.receiver.position +
         wi * ((length(request.receiver.position - center) + F(bounds.radius)) * F(margin));
}

}  // namespace etendue

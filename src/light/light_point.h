// A sampled point on a light, and the change between densities per area and per solid angle.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "base/vec.h"
#include "geometry/clearance.h"

namespace etendue {

template <class F>
struct LightPoint {
  Vec3<F> position;  ///< World, m.
  Vec3<F> ng;        ///< Unit geometric normal; what the Jacobian uses.
  F pdf_area;        ///< 1/m^2; 0: no sample.
  F clearance;       ///< How far off the surface (m) rounding cannot tell the point from it.
  Int<F> piece;  ///< 0 .. light_pieces - 1: near points of a light have near pieces; orders shadow rays only.
};

inline constexpr int light_pieces = 16;

/// Whether the front of a light at `position`, with geometric normal `ng`, faces the place `reference`.
/// Not one that lies in the light's own plane within the rounding of both places: its cosine would be an
/// error over a small number.
template <class F>
Mask<F> is_front_facing(const Vec3<F>& position, const Vec3<F>& ng, const Vec3<F>& reference) {
  const Vec3<F> places = abs_each(reference) + abs_each(position);
  return dot(ng, reference - position) > F(0.25f) * clearance<F>(ng, places, F(0));
}

/// Density per solid angle (1/sr) at the receiver from one per area (1/m^2) on the light.
/// \param cos_theta_light between the light's geometric normal and the direction to the receiver, > 0
template <class F>
F solid_angle_from_area(const F& pdf_area, const F& distance_sq, const F& cos_theta_light) {
  return pdf_area * distance_sq / cos_theta_light;
}
template <class F>
F area_from_solid_angle(const F& pdf_solid_angle, const F& distance_sq, const F& cos_theta_light) {
  return pdf_solid_angle * cos_theta_light / distance_sq;
}

}  // namespace etendue

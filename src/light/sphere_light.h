// Spherical area lights: a direction uniform in the cone that the sphere fills, or by the cosine at the
// receiver; from inside, a point uniform on it.
#pragma once

#include "base/frame.h"
#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/bounds.h"
#include "light/light_table.h"
#include "light/projected_cap.h"
#include "light/sphere_cone.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Wang 1992, "Physically correct direct lighting for distribution ray tracing" (Graphics Gems III).
class SphereLights {
 public:
  std::int32_t add(const Sphere& sphere) {
    for (const float x : {sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius})
      fields_.push_back(x);
    return std::int32_t(fields_.size() / 4) - 1;
  }

  static constexpr LightPlace place = LightPlace::surface;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    if (request.technique != LightTechnique::projected_solid_angle) return sample_cone(request);
    const ByCosine<F> by_cosine(cone_of<F>(request.row, request.receiver.position), request.receiver);
    const Mask<F> m = mask_and(request.lanes, by_cosine.lanes);
    const LightSample<F> other = all(m) ? no_light_sample<F>() : sample_cone(request);
    return any(m) ? select(m, sample_cosine(by_cosine, request, m), other) : other;
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    const F by_cone =
        pdf_solid_angle_at(hit, receiver, pmf * pdf_area<F>(row, receiver.position, hit.position, hit.ng));
    if (hit.technique != LightTechnique::projected_solid_angle) return by_cone;
    const ByCosine<F> by_cosine(cone_of<F>(row, receiver.position), receiver);
    return select(by_cosine.lanes, pmf * by_cosine.cap.pdf(hit.wi), by_cone);
  }

  double power(std::int32_t row, const Sphere& /*scene_bounds*/) const {
    const double radius = fields_[4 * std::size_t(row) + 3];
    return 4 * double(pi) * double(pi) * radius * radius;
  }
  std::optional<LightBounds> bounds(std::int32_t row) const {
    const float* field = fields_.data() + 4 * std::size_t(row);
    return LightBounds{box_of(Sphere{{field[0], field[1], field[2]}, field[3]}), {0, 0, 1}, -1, 0};
  }

  template <class F>
  LightPoint<F> sample_position(const Int<F>& row, const Vec3<F>& reference, const Vec2<UInt<F>>& u) const {
    const SphereCone<F> cone = cone_of<F>(row, reference);
    const Vec2<F> u_cone{to_unit_float(u.x), to_unit_float(u.y)};
    const F one_minus_cos = u_cone.x * cone.one_minus_cos_max;
    const Vec2<F> center =
        cone.at_center(max(one_minus_cos * (F(2) - one_minus_cos), F(0)), F(1) - one_minus_cos);
    F sine, cosine;
    sincos_turns(u_cone.y, sine, cosine);
    Vec3<F> ng = Frame<F>(-cone.to_center).world_from_local({center.x * cosine, center.x * sine, center.y});
    if (any(mask_not(cone.is_outside))) {
      const F z = F(1) - (u_cone.x + u_cone.x), across = sqrt(max(F(1) - z * z, F(0)));
      ng = select(cone.is_outside, ng, Vec3<F>{across * cosine, across * sine, z});
    }
    LightPoint<F> point;
    point.position = cone.center + ng * cone.radius;
    point.ng = ng;
    point.clearance = clearance<F>(ng, abs_each(cone.center) + abs_each(ng) * cone.radius, F(0));
    point.pdf_area = pdf_area<F>(row, reference, point.position, ng);
    point.piece = piece_at(u_cone);
    return point;
  }

  /// The density per area (1/m^2) of sample_position.
  template <class F>
  F pdf_area(const Int<F>& row, const Vec3<F>& reference, const Vec3<F>& position, const Vec3<F>& ng) const {
    const SphereCone<F> cone = cone_of<F>(row, reference);
    const Vec3<F> to_receiver = reference - position;
    const F distance_sq = length_sq(to_receiver), cos_theta_light = dot(ng, to_receiver) / sqrt(distance_sq);
    const F pdf = area_from_solid_angle(uniform_cone_pdf_solid_angle(cone.one_minus_cos_max), distance_sq,
                                        cos_theta_light);
    const F pdf_inside = F(0.25f * inv_pi) / (cone.radius * cone.radius);
    return select(cone.is_outside, select(cos_theta_light > F(0), pdf, F(0)), pdf_inside);
  }

 private:
  /// Which lanes are sampled so depends on receiver and sphere alone, so that samples and hits agree.
  template <class F>
  struct ByCosine {
    SphereCone<F> cone;
    CapOverHorizon<F> over_horizon;
    ProjectedCap<F> cap;
    Mask<F> lanes;

    ByCosine(const SphereCone<F>& of_sphere, const Receiver<F>& receiver)
        : cone(of_sphere),
          over_horizon(cone.to_center, cone.sin_max_sq, lit_normal(receiver)),
          cap(over_horizon),
          lanes(mask_and(cone.is_outside, cap.is_accurate(), is_lit_from_one_side(receiver))) {}
  };

  template <class F>
  LightSample<F> sample_cone(const LightRequest<F>& request) const {
    return light_sample_at(sample_position<F>(request.row, request.receiver.position, request.u), request);
  }

  template <class F>
  static LightSample<F> sample_cosine(const ByCosine<F>& by_cosine, const LightRequest<F>& request,
                                      const Mask<F>& m) {
    const auto& [cone, over_horizon, cap, lanes] = by_cosine;
    const Vec2<F> u{to_unit_float(request.u.x), to_unit_float(request.u.y)};
    F pdf;
    const CapDirection<F> seen = cap.sample(u, pdf);
    const F sine_sq = seen.up * seen.up + seen.across * seen.across;
    const Vec3<F> aside = over_horizon.up * seen.up + over_horizon.across * seen.across;
    const Vec2<F> center = cone.at_center(sine_sq, seen.axis);
    const Vec3<F> ng = aside * (center.x / sqrt(max(sine_sq, F(1e-37f)))) - cone.to_center * center.y;
    const Vec3<F> position = cone.center + ng * cone.radius;
    const Vec3<F> terms =
        abs_each(cone.center) + abs_each(ng) * cone.radius + abs_each(position - request.receiver.position);
    const Mask<F> is_there = mask_and(m, pdf > F(0));  // It is 0 at the end of a cut cap.
    const F arriving = select(is_there, F(1) / pdf, F(0));
    return light_sample_towards<F>(aside + cone.to_center * seen.axis,
                                   position + ng * clearance<F>(ng, terms, F(0)),
                                   {arriving, arriving, arriving}, pdf, is_there, request, piece_at(u));
  }

  template <class F>
  SphereCone<F> cone_of(const Int<F>& row, const Vec3<F>& receiver) const {
    const Int<F> at = row * Int<F>(4);
    return {gather_vec3<F>(fields_.data(), at), gather(fields_.data() + 3, at), receiver};
  }

  /// On a grid of 4 x 4.
  template <class F>
  static Int<F> piece_at(const Vec2<F>& u) {
    return to_int(u.y * F(4)) * Int<F>(4) + to_int(u.x * F(4));
  }

  std::vector<float> fields_;  ///< Centre and radius: 4 a row.
};

}  // namespace etendue

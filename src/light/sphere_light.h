// Spherical area lights: a direction uniform in the cone that the sphere fills; from inside, a point uniform
// on it.
#pragma once

#include "base/frame.h"
#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/bounds.h"
#include "light/light_table.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Wang 1992, "Physically correct direct lighting for distribution ray tracing" (Graphics Gems III).
class SphereLights {
 public:
  std::int32_t add(const Sphere& sphere) {
    fields_.insert(fields_.end(), {sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius});
    return std::int32_t(fields_.size() / 4) - 1;
  }

  static constexpr LightPlace place = LightPlace::surface;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    return light_sample_at(sample_position<F>(request.row, request.receiver.position, request.u), request);
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    return pdf_solid_angle_at(hit, receiver, pmf * pdf_area<F>(row, receiver.position, hit.position, hit.ng));
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
    const Cone<F> cone(*this, row, reference);
    const Vec2<F> u_cone{to_unit_float(u.x), to_unit_float(u.y)};
    // From the angle at the receiver to the angle at the centre, from which the point follows without
    // cancellation (Pharr, Jakob and Humphreys, Physically Based Rendering, 4th ed., section 6.2.4).
    const F one_minus_cos = u_cone.x * cone.one_minus_cos_max;
    const F cos_theta = F(1) - one_minus_cos;
    const F sin_theta_sq = max(one_minus_cos * (F(2) - one_minus_cos), F(0));
    const F sin_ratio_sq = min(sin_theta_sq / cone.sin_max_sq, F(1));
    const F sin_max = sqrt(cone.sin_max_sq);
    const F cos_center = sin_ratio_sq * sin_max + cos_theta * sqrt(F(1) - sin_ratio_sq);
    // sin(asin(ratio) - theta) as a quotient: from the cosine, points below a receiver that all but touches
    // the sphere would lie on a few rings.
    const F sin_center = sqrt(sin_ratio_sq) * (F(1) - cone.sin_max_sq) /
                         (cos_theta + sqrt(max(cone.sin_max_sq - sin_theta_sq, F(0x1p-60f))));
    F sine, cosine;
    sincos_turns(u_cone.y, sine, cosine);
    Vec3<F> ng =
        Frame<F>(-cone.to_center).world_from_local({sin_center * cosine, sin_center * sine, cos_center});
    if (any(mask_not(cone.is_outside))) {
      const F z = F(1) - (u_cone.x + u_cone.x), across = sqrt(max(F(1) - z * z, F(0)));
      ng = select(cone.is_outside, ng, Vec3<F>{across * cosine, across * sine, z});
    }
    LightPoint<F> point;
    point.position = cone.center + ng * cone.radius;
    point.ng = ng;
    point.clearance = clearance<F>(ng, abs_each(cone.center) + abs_each(ng) * cone.radius, F(0));
    point.pdf_area = pdf_area<F>(row, reference, point.position, ng);
    point.piece = to_int(u_cone.y * F(4)) * Int<F>(4) + to_int(u_cone.x * F(4));
    return point;
  }

  /// The density per area (1/m^2) of sample_position.
  template <class F>
  F pdf_area(const Int<F>& row, const Vec3<F>& reference, const Vec3<F>& position, const Vec3<F>& ng) const {
    const Cone<F> cone(*this, row, reference);
    const Vec3<F> to_receiver = reference - position;
    const F distance_sq = length_sq(to_receiver);
    const F cos_theta_light = dot(ng, to_receiver) / sqrt(distance_sq);
    const F pdf = area_from_solid_angle(uniform_cone_pdf_solid_angle(cone.one_minus_cos_max), distance_sq,
                                        cos_theta_light);
    const F pdf_inside = F(0.25f * inv_pi) / (cone.radius * cone.radius);
    return select(cone.is_outside, select(cos_theta_light > F(0), pdf, F(0)), pdf_inside);
  }

 private:
  /// The cone of directions from a receiver to the sphere.
  template <class F>
  struct Cone {
    Vec3<F> center, to_center;
    F radius, sin_max_sq, one_minus_cos_max;
    Mask<F> is_outside;

    Cone(const SphereLights& lights, const Int<F>& row, const Vec3<F>& reference) {
      const Int<F> at = row * Int<F>(4);
      const float* field = lights.fields_.data();
      center = gather_vec3<F>(field, at);
      radius = gather(field + 3, at);
      const Vec3<F> offset = center - reference;
      const F distance_sq = length_sq(offset);
      is_outside = distance_sq > radius * radius;
      to_center = offset * (F(1) / sqrt(select(is_outside, distance_sq, F(1))));
      sin_max_sq = select(is_outside, radius * radius / distance_sq, F(1));
      // 1 - sqrt(1 - s) without cancellation for small s.
      one_minus_cos_max = sin_max_sq / (F(1) + sqrt(max(F(1) - sin_max_sq, F(0))));
    }
  };

  std::vector<float> fields_;  ///< Centre and radius: 4 a row.
};

}  // namespace etendue

// Disk-shaped (and elliptic) area lights: a point uniform over the whole, or one by solid angle.
#pragma once

#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/bounds.h"
#include "light/light_table.h"
#include "light/spherical_ellipse.h"

#include <cstdint>
#include <vector>

namespace etendue {

class DiskLights {
 public:
  /// Returns the row. The disk's area must be positive and finite.
  std::int32_t add(const Disk& disk);

  static constexpr LightPlace place = LightPlace::surface;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    if (request.technique == LightTechnique::area)
      return light_sample_at(sample_position<F>(request.row, request.u), request);
    const Seen<F> seen(*this, request.row, request.receiver.position, request.is_twosided, request.technique);
    LightSample<F> result = no_light_sample<F>();
    if (any(seen.is_by_area)) {
      LightRequest<F> by_area = request;
      by_area.lanes = mask_and(request.lanes, seen.is_by_area);
      result = light_sample_at(sample_position<F>(request.row, request.u), by_area);
    }
    const Mask<F> m = mask_and(request.lanes, seen.is_facing, mask_not(seen.is_by_area));
    if (!any(m)) return result;
    const Vec2<F> u{to_unit_float(request.u.x), to_unit_float(request.u.y)};
    const auto chosen = SphericalEllipse<F>(seen.disk).sample(u);
    const Vec3<F> along_x = seen.long_axis * chosen.on_disk.x, along_y = seen.short_axis * chosen.on_disk.y;
    const Vec3<F> to_light = seen.to_center + along_x + along_y;
    const F clear = clearance<F>(
        seen.ng, abs_each(seen.center) + abs_each(along_x) + abs_each(along_y) + abs_each(to_light), F(0));
    const F arriving = select(m, F(1) / chosen.pdf, F(0));
    const LightSample<F> by_direction =
        light_sample_towards<F>(normalize(to_light), request.receiver.position + to_light + seen.ng * clear,
                                {arriving, arriving, arriving}, chosen.pdf, m, request, piece_at(u));
    return select(m, by_direction, result);
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    const F by_area = pdf_solid_angle_at(hit, receiver, pmf * pdf_area_.at(row));
    if (hit.technique == LightTechnique::area) return by_area;
    const Mask<F> every_lane = F(0) < F(1);
    const Seen<F> seen(*this, row, receiver.position, every_lane, hit.technique);
    if (all(seen.is_by_area)) return by_area;
    const Vec3<F> from_center = hit.position - seen.center;
    const Vec2<F> on_disk{dot(from_center, seen.long_axis) / length_sq(seen.long_axis),
                          dot(from_center, seen.short_axis) / length_sq(seen.short_axis)};
    const F pdf = pmf * SphericalEllipse<F>(seen.disk).pdf(on_disk);
    return select(seen.is_by_area, by_area, select(seen.is_facing, pdf, F(0)));
  }

  double power(std::int32_t row, const Sphere& /*scene_bounds*/) const { return pi / pdf_area_[row]; }
  std::optional<LightBounds> bounds(std::int32_t row) const {
    const float* field = fields_.data() + 12 * std::size_t(row);
    const auto vec = [&](int column) { return Vec3f{field[column], field[column + 1], field[column + 2]}; };
    const Disk disk{vec(0), vec(3), vec(6), vec(9)};
    return LightBounds{box_of(disk), disk.ng, 1, 0};
  }

  template <class F>
  LightPoint<F> sample_position(const Int<F>& row, const Vec2<UInt<F>>& u) const {
    const Int<F> at = row * Int<F>(12);
    const auto vec = [&](int column) { return gather_vec3<F>(fields_.data() + column, at); };
    const Vec2<F> u_disk{to_unit_float(u.x), to_unit_float(u.y)};
    // An affine map keeps a uniform density uniform.
    const Vec2<F> on_disk = square_to_uniform_disk(u_disk);
    const Vec3<F> ng = vec(9);
    const Vec3<F> center = vec(0), along_x = vec(3), along_y = vec(6);
    const F clear = clearance<F>(ng, abs_each(center) + abs_each(along_x) + abs_each(along_y), F(0));
    return {center + along_x * on_disk.x + along_y * on_disk.y, ng, pdf_area_.at(row), clear,
            piece_at(u_disk)};
  }

 private:
  /// On a grid of 4 x 4.
  template <class F>
  static Int<F> piece_at(const Vec2<F>& u) {
    return to_int(u.x * F(4)) * Int<F>(4) + to_int(u.y * F(4));
  }

  /// One disk for one receiver. Which technique serves a lane depends on both alone, so that samples and the
  /// densities of hits agree.
  template <class F>
  struct Seen {
    Vec3<F> center, to_center, long_axis, short_axis, ng;  ///< m; ng on the side that faces the receiver.
    SeenDisk<F> disk;
    Mask<F> is_facing, is_by_area;

    Seen(const DiskLights& lights, const Int<F>& row, const Vec3<F>& position, const Mask<F>& is_twosided,
         LightTechnique technique) {
      const float* field = lights.fields_.data();
      const Int<F> at = row * Int<F>(12), axes_at = row * Int<F>(6);
      center = gather_vec3<F>(field, at);
      ng = gather_vec3<F>(field + 9, at);
      long_axis = gather_vec3<F>(lights.half_axes_.data(), axes_at);
      short_axis = gather_vec3<F>(lights.half_axes_.data() + 3, axes_at);
      to_center = center - position;
      const Mask<F> is_turned = mask_and(is_twosided, dot(ng, to_center) > F(0));
      ng = select(is_turned, -ng, ng);
      is_facing = is_front_facing(center, ng, position);
      const F long_sq = length_sq(long_axis), short_sq = length_sq(short_axis);
      const F inv_long = F(1) / sqrt(long_sq), inv_short = F(1) / sqrt(short_sq);
      // What does not face the receiver gets any height that can be computed with.
      disk = {dot(to_center, long_axis) * (inv_long * inv_long),
              dot(to_center, short_axis) * (inv_short * inv_long),
              select(is_facing, -dot(ng, to_center) * inv_long, F(1)), short_sq * (inv_long * inv_long)};
      const Mask<F> none = F(1) < F(0);
      is_by_area = technique == LightTechnique::automatic || technique == LightTechnique::transformed_cosine
                       ? is_small_from(length_sq(to_center),
                                       spread_of(F(1) / lights.pdf_area_.at(row), F(4) * long_sq))
                       : none;
    }
  };

  std::vector<float> fields_;     ///< Centre, the two axes, normal: 12 a row.
  std::vector<float> half_axes_;  ///< The longer and the shorter half axis, at right angles: 6 a row.
  LookupTable<float> pdf_area_;
};

}  // namespace etendue

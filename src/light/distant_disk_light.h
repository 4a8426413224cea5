// Distant disks: constant radiance from a cone of directions at infinity, up to all of them.
#pragma once

#include "base/color.h"
#include "base/frame.h"
#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/warp.h"
#include "light/light_table.h"
#include "light/technique.h"
#include "scenefile/parameters.h"

#include <cstdint>
#include <vector>

namespace etendue {

struct DistantDisk {
  Vec3f axis;        ///< Unit, world: towards the middle of the disk.
  float half_angle;  ///< From the axis to the rim, radians, 0 < half_angle <= pi.
  Colorf radiance;   ///< W/(m^2 sr)
};

/// Strength: radiance, W/(m^2 sr). Directions are uniform in the cone; of a light from everywhere, where the
/// technique is not area or solid_angle, in proportion to the cosine at receivers that are lit from one side.
class DistantDiskLights {
 public:
  std::int32_t add(const DistantDisk& disk);

  static constexpr LightPlace place = LightPlace::infinity;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    const Int<F> at = request.row * Int<F>(3);
    const Vec3<F> axis = gather_vec3<F>(axes_.data(), at);
    const F one_minus_cos_max = one_minus_cos_max_.at(request.row);
    const Vec2<F> u_cone{to_unit_float(request.u.x), to_unit_float(request.u.y)};
    Vec3<F> wi = Frame<F>(axis).world_from_local(square_to_uniform_cone(u_cone, one_minus_cos_max));
    F pdf = uniform_cone_pdf_solid_angle(one_minus_cos_max);
    const Mask<F> by_cosine =
        mask_and(request.lanes, is_by_cosine(one_minus_cos_max, request.receiver, request.technique));
    if (any(by_cosine)) {
      const Vec3<F> around_normal = square_to_cosine_hemisphere(u_cone);
      wi = select(by_cosine, Frame<F>(lit_normal(request.receiver)).world_from_local(around_normal), wi);
      pdf = select(by_cosine, cosine_hemisphere_pdf_solid_angle(around_normal.z), pdf);
    }
    const F arriving = F(1) / pdf;
    const Int<F> piece = to_int(u_cone.y * F(4)) * Int<F>(4) + to_int(u_cone.x * F(4));
    return light_sample_towards<F>(wi, beyond_scene(request, wi), {arriving, arriving, arriving}, pdf,
                                   request.lanes, request, piece);
  }

  double power(std::int32_t row, const Sphere& scene_bounds) const {
    return 2 * double(pi) * one_minus_cos_max_[row] * cross_section(scene_bounds);
  }
  std::optional<LightBounds> bounds(std::int32_t /*row*/) const { return std::nullopt; }

  /// Per unit of strength: 1 within the disk, else 0.
  template <class F>
  Color<F> radiance(std::int32_t row, const Vec3<F>& direction, const Mask<F>& /*lanes*/) const {
    const F one = select(is_within<F>(row, direction), F(1), F(0));
    return {one, one, one};
  }

  /// The density (1/sr) with which `sample` gives `direction`.
  template <class F>
  F pdf_solid_angle(std::int32_t row, const Receiver<F>& receiver, const Vec3<F>& direction,
                    LightTechnique technique, const Mask<F>& /*lanes*/) const {
    const F one_minus_cos_max(one_minus_cos_max_[row]);
    const F pdf = select(is_within<F>(row, direction), uniform_cone_pdf_solid_angle(one_minus_cos_max), F(0));
    return select(is_by_cosine(one_minus_cos_max, receiver, technique),
                  cosine_hemisphere_pdf_solid_angle(dot(lit_normal(receiver), direction)), pdf);
  }

 private:
  template <class F>
  static Mask<F> is_by_cosine(const F& one_minus_cos_max, const Receiver<F>& receiver,
                              LightTechnique technique) {
    if (technique == LightTechnique::area || technique == LightTechnique::solid_angle) return F(1) < F(0);
    constexpr float of_all = 2;
    return mask_and(one_minus_cos_max >= F(of_all), is_lit_from_one_side(receiver));
  }

  template <class F>
  Mask<F> is_within(std::int32_t row, const Vec3<F>& direction) const {
    const float* axis = axes_.data() + 3 * row;
    // 1 - cos without cancellation: the sun is a disk of 0.27 degrees.
    const Vec3<F> chord = direction - Vec3<F>{F(axis[0]), F(axis[1]), F(axis[2])};
    return length_sq(chord) * F(0.5f) <= F(rim_[std::size_t(row)]);
  }

  std::vector<float> axes_;
  LookupTable<float> one_minus_cos_max_;  ///< At the rim.
  std::vector<float> rim_;                ///< The same, but no direction is beyond the rim of a full sphere.
};

extern const Plugin distant_disk_plugin, constant_plugin;
DistantDisk make_distant_disk(const Object& description, std::vector<UnreadKey>& unread);
/// The disk of half angle pi.
DistantDisk make_constant_environment(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

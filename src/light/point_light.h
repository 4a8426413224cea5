// Point lights: alike in all directions, from one point.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "base/warp.h"
#include "light/light_table.h"
#include "scenefile/parameters.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Strength: radiant intensity, W/sr.
class PointLights {
 public:
  std::int32_t add(const Vec3f& position) {
    positions_.push_back(position);
    return std::int32_t(positions_.size()) - 1;
  }

  static constexpr LightPlace place = LightPlace::nowhere;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    const Vec3<F> position = gather_vec3<F>(&positions_[0].x, request.row * Int<F>(3));
    const Vec3<F> to_light = position - request.receiver.position;
    const F inv_distance_sq = F(1) / length_sq(to_light);
    return light_sample_towards<F>(to_light * sqrt(inv_distance_sq), position,
                                   {inv_distance_sq, inv_distance_sq, inv_distance_sq}, dirac_pdf<F>(),
                                   request.lanes, request);
  }

  double power(std::int32_t /*row*/, const Sphere& /*scene_bounds*/) const { return 4 * double(pi); }
  std::optional<LightBounds> bounds(std::int32_t row) const {
    const Vec3f& position = positions_[std::size_t(row)];
    return LightBounds{{position, position}, {0, 0, 1}, -1, 0};
  }

 private:
  std::vector<Vec3f> positions_;
};

struct PointLight {
  Vec3f position;    ///< World, m.
  Colorf intensity;  ///< W/sr
};
extern const Plugin point_plugin;
PointLight make_point_light(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

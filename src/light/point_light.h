// Point lights: alike in all directions, from one point.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "light/light_sample.h"
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

  template <class F>
  LightSample<F> sample(const Sphere& /*scene_bounds*/, const Int<F>& row, const Vec3<F>& reference,
                        const Vec2<UInt<F>>& /*u*/, const Mask<F>& m) const {
    const Vec3<F> position = gather_vec3<F>(&positions_[0].x, row * Int<F>(3));
    const Vec3<F> to_light = position - reference;
    const F inv_distance_sq = F(1) / length_sq(to_light);
    return light_sample_towards<F>(to_light * sqrt(inv_distance_sq), position,
                                   {inv_distance_sq, inv_distance_sq, inv_distance_sq}, dirac_pdf<F>(), m);
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

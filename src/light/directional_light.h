// Directional lights: parallel light from infinitely far away, like the sun's.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "light/light_sample.h"
#include "scenefile/parameters.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Strength: irradiance on a surface that faces the light, W/m^2.
class DirectionalLights {
 public:
  /// \param direction unit, world: where the light travels
  std::int32_t add(const Vec3f& direction) {
    directions_.push_back(direction);
    return std::int32_t(directions_.size()) - 1;
  }

  template <class F>
  LightSample<F> sample(const Sphere& scene_bounds, const Int<F>& row, const Vec3<F>& reference,
                        const Vec2<UInt<F>>& /*u*/, const Mask<F>& m) const {
    const Vec3<F> wi = -gather_vec3<F>(&directions_[0].x, row * Int<F>(3));
    return light_sample_towards<F>(wi, beyond_scene(scene_bounds, reference, wi), {F(1), F(1), F(1)},
                                   dirac_pdf<F>(), m);
  }

 private:
  std::vector<Vec3f> directions_;
};

struct DirectionalLight {
  Vec3f direction;    ///< Unit, world: where the light travels.
  Colorf irradiance;  ///< W/m^2
};
extern const Plugin directional_plugin;
DirectionalLight make_directional_light(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

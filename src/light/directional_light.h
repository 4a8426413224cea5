// Directional lights: parallel light from infinitely far away, like the sun's.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "light/light_table.h"
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

  static constexpr LightPlace place = LightPlace::nowhere;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    const Vec3<F> wi = -gather_vec3<F>(&directions_[0].x, request.row * Int<F>(3));
    return light_sample_towards<F>(wi, beyond_scene(request, wi), {F(1), F(1), F(1)}, dirac_pdf<F>(),
                                   request.lanes, request);
  }

  double power(std::int32_t /*row*/, const Sphere& scene_bounds) const { return cross_section(scene_bounds); }
  std::optional<LightBounds> bounds(std::int32_t /*row*/) const { return std::nullopt; }

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

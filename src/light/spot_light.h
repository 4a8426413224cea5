// Spot lights: from one point into a cone, whose edge is soft.
#pragma once

#include "base/color.h"
#include "base/lane_vec.h"
#include "light/light_table.h"
#include "scenefile/parameters.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Angles are from the axis, in radians, 0 <= beam <= cutoff <= pi.
struct SpotLight {
  Vec3f position;    ///< World, m.
  Vec3f axis;        ///< Unit, world, where it shines.
  float beam;        ///< Full intensity up to here.
  float cutoff;      ///< None from here on.
  Colorf intensity;  ///< On the axis, W/sr.
};

/// Strength: radiant intensity on the axis, W/sr. Between beam and cutoff the intensity falls linearly with
/// the angle, as in Mitsuba 0.x: times (cutoff - angle) / (cutoff - beam).
class SpotLights {
 public:
  std::int32_t add(const SpotLight& spot);

  static constexpr LightPlace place = LightPlace::nowhere;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    const Int<F> at = request.row * Int<F>(columns);
    const auto field = [&](int column) { return gather(fields_.data() + column, at); };
    const Vec3<F> position = gather_vec3<F>(fields_.data(), at),
                  axis = gather_vec3<F>(fields_.data() + 3, at);
    const Vec3<F> to_light = position - request.receiver.position;
    const F inv_distance_sq = F(1) / length_sq(to_light);
    const Vec3<F> wi = to_light * sqrt(inv_distance_sq);
    // From the sine too: the cosine alone does not know small angles.
    const F angle = atan2(length(cross(axis, wi)), -dot(axis, wi));
    const F falloff = min(max(field(6) - angle * field(7), F(0)), F(1));
    const F arriving = falloff * inv_distance_sq;
    return light_sample_towards<F>(wi, position, {arriving, arriving, arriving}, dirac_pdf<F>(),
                                   mask_and(request.lanes, falloff > F(0)), request);
  }

  double power(std::int32_t row, const Sphere& scene_bounds) const;
  std::optional<LightBounds> bounds(std::int32_t row) const;

 private:
  static constexpr int columns = 8;
  std::vector<float> fields_;  ///< Position, axis, cutoff / (cutoff - beam), 1 / (cutoff - beam).
};

/// Power (W) of a spot of intensity 1 W/sr on the axis: 2 pi (1 - (sin cutoff - sin beam) / (cutoff - beam)).
double spot_power(double beam, double cutoff);

extern const Plugin spot_plugin;
SpotLight make_spot_light(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

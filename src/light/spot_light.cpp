#include "light/spot_light.h"

#include "light/light_parameters.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace etendue {

using Type = Parameter::Type;

const Plugin spot_plugin{
    "light",
    "spot",
    "Shines from a point into a cone; cannot be seen. The intensity is full up to beamWidth from the axis "
    "and "
    "falls linearly with the angle to 0 at cutoffAngle.",
    {{"intensity", Type::color, "1", "W/sr", "Radiant intensity on the axis"},
     {"power", Type::color, "", "W", "Instead of the intensity: all that the cone sends out"},
     {"cutoffAngle", Type::real, "20", "deg", "From the axis to where the light ends"},
     {"beamWidth", Type::real, "", "deg",
      "From the axis to where it begins to fall; 3/4 of cutoffAngle unless given"},
     {"position", Type::point, "0 0 0", "m", "Where it is; toWorld applies"},
     {"direction", Type::vector, "0 0 1", "", "Where it shines; toWorld applies"},
     {"toWorld", Type::transform, "", "", "World from light; identity unless given"}},
    {}};

std::int32_t SpotLights::add(const SpotLight& spot) {
  // A spot with a sharp edge falls over one rounding error.
  const float width = std::max(spot.cutoff - spot.beam, 1e-6f);
  for (const Vec3f& v : {spot.position, spot.axis}) fields_.insert(fields_.end(), {v.x, v.y, v.z});
  fields_.insert(fields_.end(), {spot.cutoff / width, 1 / width});
  return std::int32_t(fields_.size() / columns) - 1;
}

double SpotLights::power(std::int32_t row, const Sphere& /*scene_bounds*/) const {
  const float* field = fields_.data() + columns * std::size_t(row);
  const double width = 1 / double(field[7]), cutoff = double(field[6]) * width;
  return spot_power(cutoff - width, cutoff);
}

std::optional<LightBounds> SpotLights::bounds(std::int32_t row) const {
  const float* field = fields_.data() + columns * std::size_t(row);
  const Vec3f position{field[0], field[1], field[2]}, axis{field[3], field[4], field[5]};
  const double cutoff = double(field[6]) / double(field[7]);
  // Rounded to a wider cone.
  return LightBounds{{position, position}, axis, 1, std::max(float(std::cos(cutoff)) - 1e-5f, -1.0f)};
}

double spot_power(double beam, double cutoff) {
  // The mean cosine between the two angles, which is the cosine where they meet.
  const double width = cutoff - beam;
  const double mean_cosine =
      width > 1e-6 ? (std::sin(cutoff) - std::sin(beam)) / width : std::cos(0.5 * (cutoff + beam));
  return 2 * std::numbers::pi * (1 - mean_cosine);
}

SpotLight make_spot_light(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, spot_plugin, unread);
  const double cutoff_deg = parameters.real("cutoffAngle");
  if (!(cutoff_deg > 0 && cutoff_deg <= 180))
    throw InputError(parameters.location("cutoffAngle"),
                     fmt::format("'cutoffAngle' is {}; it must be above 0 and at most 180", cutoff_deg));
  const double beam_deg = parameters.has("beamWidth") ? parameters.real("beamWidth") : 0.75 * cutoff_deg;
  if (!(beam_deg >= 0 && beam_deg <= cutoff_deg))
    throw InputError(
        parameters.location("beamWidth"),
        fmt::format("'beamWidth' is {}; it must be from 0 to cutoffAngle, {}", beam_deg, cutoff_deg));
  const double beam = beam_deg / 180 * std::numbers::pi, cutoff = cutoff_deg / 180 * std::numbers::pi;
  const std::string_view strength = stated_one_of(parameters, "intensity", "power");
  const Colorf given = nonnegative_color(parameters, strength);
  return {world_point(parameters, "position"), world_direction(parameters, "direction"), float(beam),
          float(cutoff), strength == "power" ? given * float(1 / spot_power(beam, cutoff)) : given};
}

}  // namespace etendue

#include "light/distant_disk_light.h"

#include "light/light_parameters.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace etendue {

using Type = Parameter::Type;

const Plugin distant_disk_plugin{
    "light",
    "distantdisk",
    "A disk at infinity about the light's +z, of constant radiance.",
    {{"radiance", Type::color, "1", "W/(m^2 sr)", "Radiance"},
     {"thetaA", Type::real, "", "deg",
      "From the axis to the rim: 90 is half of all directions, 180 all of them", true},
     {"toWorld", Type::transform, "", "", "World from light, a rotation; identity unless given"}},
    {}};

const Plugin constant_plugin{"light",
                             "constant",
                             "The same radiance from all directions.",
                             {{"radiance", Type::color, "1", "W/(m^2 sr)", "Radiance"},
                              {"toWorld", Type::transform, "", "", "Changes nothing"}},
                             {}};

std::int32_t DistantDiskLights::add(const DistantDisk& disk) {
  axes_.insert(axes_.end(), {disk.axis.x, disk.axis.y, disk.axis.z});
  const double sine = std::sin(0.5 * double(disk.half_angle));
  const auto one_minus_cos = float(2 * sine * sine);
  one_minus_cos_max_.push_back(one_minus_cos);
  constexpr float beyond_any = 4;
  rim_.push_back(disk.half_angle >= std::numbers::pi_v<float> ? beyond_any : one_minus_cos);
  return one_minus_cos_max_.size() - 1;
}

DistantDisk make_distant_disk(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, distant_disk_plugin, unread);
  const double angle_deg = parameters.real("thetaA");
  constexpr double smallest_deg = 1e-3;
  if (!(angle_deg >= smallest_deg && angle_deg <= 180))
    throw InputError(parameters.location("thetaA"),
                     fmt::format("'thetaA' is {}; it must be from {} to 180", angle_deg, smallest_deg),
                     "for a light from one direction use <emitter type=\"directional\">");
  const Vec3<double> axis = transform_vector(rotation_from_light(parameters), {0, 0, 1});
  return {{float(axis.x), float(axis.y), float(axis.z)},
          float(angle_deg / 180 * std::numbers::pi),
          nonnegative_color(parameters, "radiance")};
}

DistantDisk make_constant_environment(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, constant_plugin, unread);
  return {{0, 0, 1}, std::numbers::pi_v<float>, nonnegative_color(parameters, "radiance")};
}

}  // namespace etendue

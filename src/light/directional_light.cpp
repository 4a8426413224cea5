#include "light/directional_light.h"

#include "light/light_parameters.h"

namespace etendue {

using Type = Parameter::Type;

const Plugin directional_plugin{
    "light",
    "directional",
    "Parallel light from infinitely far away; cannot be seen.",
    {{"irradiance", Type::color, "1", "W/m^2", "On a surface that faces the light"},
     {"radiance", Type::color, "", "W/m^2", "The same by the name that forks of Nori use for it"},
     {"direction", Type::vector, "0 0 1", "", "Where the light travels; toWorld applies"},
     {"toWorld", Type::transform, "", "", "World from light; identity unless given"}},
    {}};

DirectionalLight make_directional_light(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, directional_plugin, unread);
  return {world_direction(parameters, "direction"),
          nonnegative_color(parameters, stated_one_of(parameters, "irradiance", "radiance"))};
}

}  // namespace etendue

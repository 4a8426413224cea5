#include "light/point_light.h"

#include "base/warp.h"
#include "light/light_parameters.h"

namespace etendue {

using Type = Parameter::Type;

const Plugin point_plugin{
    "light",
    "point",
    "Shines from a point, alike in all directions; cannot be seen.",
    {{"intensity", Type::color, "1", "W/sr", "Radiant intensity"},
     {"power", Type::color, "", "W", "Instead of the intensity: power / (4 pi) is the intensity"},
     {"position", Type::point, "0 0 0", "m", "Where it is; toWorld applies"},
     {"toWorld", Type::transform, "", "", "World from light; identity unless given"}},
    {}};

PointLight make_point_light(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, point_plugin, unread);
  const std::string_view strength = stated_one_of(parameters, "intensity", "power");
  const Colorf given = nonnegative_color(parameters, strength);
  return {world_point(parameters, "position"), strength == "power" ? given * (0.25f * inv_pi) : given};
}

}  // namespace etendue

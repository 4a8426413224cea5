#include "texture/checkerboard.h"

#include <cmath>

namespace etendue {

const Plugin checkerboard_plugin{
    "texture",
    "checkerboard_color",
    "Squares of two colours: value1 where floor(u / scale - delta) and the same of v have an even sum.",
    {{"value1", Parameter::Type::color, "0", "", "Colour of the squares with an even sum"},
     {"value2", Parameter::Type::color, "1", "", "Colour of the others"},
     {"scale", Parameter::Type::point2, "1, 1", "", "Size of a square in u and v; not 0"},
     {"delta", Parameter::Type::point2, "0, 0", "", "Shift, in squares"}},
    {}};

Checkerboard make_checkerboard(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, checkerboard_plugin, unread);
  const Vec2<double> delta = parameters.point2("delta"), scale = parameters.point2("scale");
  const Checkerboard texture{nonnegative_color(parameters, "value1"),
                             nonnegative_color(parameters, "value2"),
                             {float(delta.x), float(delta.y)},
                             {float(scale.x), float(scale.y)}};
  const auto is_size = [](float size) { return std::isfinite(size) && std::isfinite(1 / size); };
  if (!is_size(texture.scale.x) || !is_size(texture.scale.y))
    throw InputError(parameters.location("scale"), "'scale' is the size of a square; it must not be 0");
  return texture;
}

}  // namespace etendue

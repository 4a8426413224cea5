#include "light/light.h"

#include <utility>

namespace etendue {

std::int32_t Lights::add(const Colorf& strength, std::string name, LightKind kind, std::int32_t row) {
  if (is_area_light(kind)) ++area_count_;
  if (is_infinite_light(kind)) infinite_.push_back(count());
  kind_.push_back(std::int32_t(kind));
  row_.push_back(row);
  red_.push_back(strength.r);
  green_.push_back(strength.g);
  blue_.push_back(strength.b);
  names_.push_back(std::move(name));
  return count() - 1;
}

}  // namespace etendue

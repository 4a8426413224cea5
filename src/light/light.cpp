#include "light/light.h"

#include <utility>

namespace etendue {

std::int32_t Lights::add(const Colorf& radiance, std::string name, LightKind kind, std::int32_t row) {
  kind_.push_back(std::int32_t(kind));
  row_.push_back(row);
  red_.push_back(radiance.r);
  green_.push_back(radiance.g);
  blue_.push_back(radiance.b);
  names_.push_back(std::move(name));
  return count() - 1;
}

}  // namespace etendue

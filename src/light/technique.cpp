#include "light/technique.h"

#include "base/error.h"

#include <array>
#include <string>
#include <vector>

namespace etendue {

namespace {
/// In the order of the enumerators.
constexpr std::array<std::string_view, 5> technique_names{"area", "solid_angle", "projected", "auto", "ltc"};
}  // namespace

std::string_view light_technique_name(LightTechnique technique) {
  return technique_names[std::size_t(technique)];
}

LightTechnique light_technique_from_name(std::string_view name) {
  for (std::size_t k = 0; k < technique_names.size(); ++k)
    if (technique_names[k] == name) return LightTechnique(k);
  throw InputError(
      "unknown technique '" + std::string(name) + "'\n" +
      known_names(name, std::vector<std::string>(technique_names.begin(), technique_names.end())));
}

}  // namespace etendue

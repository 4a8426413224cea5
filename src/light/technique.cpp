#include "light/technique.h"

#include "base/error.h"

#include <array>
#include <string>
#include <vector>

namespace etendue {

namespace {
/// In the order of the enumerators.
constexpr std::array<std::string_view, 5> names{"area", "solid_angle", "projected", "auto", "ltc"};
}  // namespace

std::string_view light_technique_name(LightTechnique technique) { return names[std::size_t(technique)]; }

LightTechnique light_technique_from_name(std::string_view name) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return LightTechnique(k);
  throw InputError("unknown technique '" + std::string(name) + "'\n" +
                   known_names(name, std::vector<std::string>(names.begin(), names.end())));
}

}  // namespace etendue

// The lights of a scene by name: what is told of one light, or of several with one name.
#pragma once

#include "light/light.h"

#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

/// Lights with one name are one group; so are all weaker ones, "others", where there are too many names.
struct LightGroups {
  std::vector<std::string> names;  ///< In the order of the file; '.' in a name, which ends a layer's, is '_'.
  std::vector<std::int32_t> of_light;  ///< By a light's id.
  int others = 0;                      ///< Names that have no group of their own.
};

/// \param most groups: those of the greatest power, and `others`
LightGroups light_groups(const Lights& lights, int most);

}  // namespace etendue

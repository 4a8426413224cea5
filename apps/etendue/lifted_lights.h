// Lights that lie in one plane with another surface, taken to lie before it.
#pragma once

#include "lint/lint.h"
#include "scene/load_scene.h"

#include <vector>

namespace etendue::app {

/// Where `findings` have lights to lift: loads the scene again with them lifted, and says so unless
/// `is_quiet`. \param loading how `loaded` was loaded; gets what was lifted \param loaded keeps its sampler
void lift_lights(const SceneDesc& description, const std::vector<Finding>& findings, bool is_quiet,
                 LoadSettings& loading, LoadedScene& loaded);

}  // namespace etendue::app

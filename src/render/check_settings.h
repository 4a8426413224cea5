// Which numbers of samples a render can do.
#pragma once

#include "render/render.h"

namespace etendue {

/// Throws InputError where there are no samples, where they cannot be split into the replicates, or where
/// they are more than can be told apart.
void check_settings(const RenderSettings& settings);

}  // namespace etendue

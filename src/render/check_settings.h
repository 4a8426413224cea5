// Which numbers of samples a render can do.
#pragma once

#include "render/render.h"

#include <cstdint>

namespace etendue {

/// Throws InputError where there are no samples, where they cannot be split into the replicates, or where
/// they are more than can be told apart.
void check_settings(const RenderSettings& settings);

/// The most samples of a pixel that pilots may ask for: a quarter of those that can be told apart.
std::int64_t most_samples_of_pixel(const IntegratorSettings& integrator);

}  // namespace etendue

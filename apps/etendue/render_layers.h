// What --layers and --noise ask for.
#pragma once

#include "render/image_layers.h"
#include "render_options.h"

#include <vector>

namespace etendue::app {

struct RenderLayers {
  std::vector<ImageLayer> of_image;
  LightGroups noise_lights;  ///< Told apart in RenderSettings::noise_parts, by technique_layers.
};

/// Puts them into the settings, and says on stderr which lights share a layer. Throws InputError for an
/// unknown layer, and where the integrator traces no paths and so has no parts.
RenderLayers render_layers(const RenderOptions& options, const Lights& lights, RenderSettings& settings);

}  // namespace etendue::app

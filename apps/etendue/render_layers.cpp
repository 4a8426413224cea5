#include "render_layers.h"

#include "base/error.h"
#include "messages.h"

#include <fmt/format.h>
#include <variant>

namespace etendue::app {

namespace {

constexpr int most_noise_lights = 8;

void check_has_parts(const RenderSettings& settings, const std::string& option) {
  if (!settings.integrator.path_rules())
    throw InputError(fmt::format("{}: the integrator '{}' has no light whose parts could be told apart",
                                 option, settings.integrator.name));
}

}  // namespace

RenderLayers render_layers(const RenderOptions& options, const Lights& lights, RenderSettings& settings) {
  RenderLayers layers;
  if (!options.layers.empty()) {
    const LightGroups groups = light_groups(lights, most_light_layers);
    layers.of_image = image_layers(options.layers, groups);
    for (const ImageLayer& layer : layers.of_image) {
      const auto* radiance = std::get_if<RadianceLayers>(&layer.what);
      if (!radiance) continue;
      check_has_parts(settings, "--layers " + layer.name);
      settings.layers.push_back(radiance->set);
      if (layer.name == "light" && groups.others > 0 && !options.is_quiet)
        say("the {} strongest lights have layers of their own; the other {} are in light.others\n",
            most_light_layers - 1, groups.others);
    }
  }
  if (options.is_noise_told) {
    check_has_parts(settings, "--noise");
    layers.noise_lights = light_groups(lights, most_noise_lights);
    settings.noise_parts = layers_of_lights(technique_layers(), layers.noise_lights);
  }
  return layers;
}

}  // namespace etendue::app

// The layers of an image beside its radiance, by name.
//
// To add one: a row in the table in image_layers.cpp. Parts of the radiance are a LayerSet with a name for
// each layer; what the camera sees first, a function of FirstHit for each channel; all else, a function of
// the render.
#pragma once

#include "film/pixel_intervals.h"
#include "image/image_file.h"
#include "render/first_hits.h"
#include "render/light_groups.h"
#include "render/render.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace etendue {

/// Parts of the radiance: of all that are asked for, in the order of RenderResult::layers.
struct RadianceLayers {
  LayerSet set;
  std::vector<std::string> names;  ///< Of its layers.
};

/// What a layer that is no part of the radiance may look at.
struct LayerSource {
  const RenderSettings& settings;
  const RenderResult& result;
  std::span<const PixelInterval> intervals;
};

struct HitChannel {
  std::string_view name;
  float (*value)(const FirstHit& hit);
};
using HitLayer = std::vector<HitChannel>;
struct RenderLayer {
  std::string_view channel;
  std::vector<float> (*values)(const LayerSource& source);
};

struct ImageLayer {
  std::string name;
  std::variant<RadianceLayers, HitLayer, RenderLayer> what;
};

struct KnownLayer {
  std::string_view name, meaning;
};
std::vector<KnownLayer> known_layers();

/// Lights that have a layer of their own, at most.
constexpr int most_light_layers = 32;

/// Throws InputError with the known names for one that is none of them, and where it is given twice.
std::vector<ImageLayer> image_layers(const std::vector<std::string>& names, const LightGroups& groups);

/// By emission (what the camera sees), light samples and BSDF samples: part 0, 1 and 2 of the paths.
constexpr std::array<std::string_view, 3> technique_layer_names{"emission", "light", "bsdf"};
LayerSet technique_layers();
/// One layer of all light but that of the lights that the camera sees, which is the same by all techniques,
/// and whose outlines are noise.
LayerSet scattered_light();
/// A set with each group of lights told apart.
LayerSet layers_of_lights(const LayerSet& of_paths, const LightGroups& groups);

/// "light.lamp.R", "light.lamp.stderr.R" ...: a part of the radiance that two of the layers have is there
/// once.
std::vector<Channel> layer_channels(const std::vector<ImageLayer>& layers, const Scene& scene,
                                    const LayerSource& source);

}  // namespace etendue

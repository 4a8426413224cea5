#include "scene/load_light.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <utility>
#include <variant>

namespace etendue {

namespace {

const Plugin area_plugin{
    "light",
    std::string(area_light_name),
    "The shape shines from its front side, alike in all directions.",
    {{"radiance", Parameter::Type::color, "1", "W/(m^2 sr)", "Emitted radiance", false, true},
     {"scale", Parameter::Type::real, "1", "", "Factor of the radiance"},
     {"twosided", Parameter::Type::boolean, "false", "", "Shines from its back side too"}},
    {}};

/// What a maker is told.
struct LightDescription {
  const Object& object;
  const std::filesystem::path& directory;
  std::vector<UnreadKey>& unread;
  std::string name;
};

void add_point(const LightDescription& d, Lights& lights) {
  const PointLight light = make_point_light(d.object, d.unread);
  lights.add<PointLights>(light.intensity, d.name, light.position);
}
void add_spot(const LightDescription& d, Lights& lights) {
  const SpotLight light = make_spot_light(d.object, d.unread);
  lights.add<SpotLights>(light.intensity, d.name, light);
}
void add_directional(const LightDescription& d, Lights& lights) {
  const DirectionalLight light = make_directional_light(d.object, d.unread);
  lights.add<DirectionalLights>(light.irradiance, d.name, light.direction);
}
void add_distant_disk(const LightDescription& d, Lights& lights) {
  const DistantDisk light = make_distant_disk(d.object, d.unread);
  lights.add<DistantDiskLights>(light.radiance, d.name, light);
}
void add_constant(const LightDescription& d, Lights& lights) {
  const DistantDisk light = make_constant_environment(d.object, d.unread);
  lights.add<DistantDiskLights>(light.radiance, d.name, light);
}
void add_envmap(const LightDescription& d, Lights& lights) {
  EnvmapLight light = make_envmap_light(d.object, d.directory, d.unread);
  lights.add<EnvmapLights>({light.scale, light.scale, light.scale}, d.name, std::move(light.map),
                           light.world_from_map);
}

/// The kinds that are no shapes.
struct Maker {
  const Plugin& plugin;
  void (*add)(const LightDescription& description, Lights& lights);
};
const Maker makers[]{{point_plugin, add_point},
                     {spot_plugin, add_spot},
                     {directional_plugin, add_directional},
                     {distant_disk_plugin, add_distant_disk},
                     {constant_plugin, add_constant},
                     {envmap_plugin, add_envmap}};

}  // namespace

bool is_light(const Object& object) { return object.family == "luminaire" || object.family == "emitter"; }

const std::vector<Plugin>& light_plugins() {
  static const std::vector<Plugin> plugins = [] {
    std::vector<Plugin> all{area_plugin};
    for (const Maker& maker : makers) all.push_back(maker.plugin);
    return all;
  }();
  return plugins;
}

AreaLight make_area_light(const Object& description, TextureFiles& textures, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, area_plugin, unread);
  const double scale = parameters.real("scale");
  if (!(scale >= 0 && scale <= std::numeric_limits<float>::max()))
    throw InputError(parameters.location("scale"),
                     fmt::format("'scale' is {}; it must be finite and not negative", scale));
  AreaLight light;
  light.is_twosided = parameters.boolean("twosided");
  const ColorTexture radiance = read_color_texture(parameters, "radiance", textures, unread);
  if (const Colorf* color = std::get_if<Colorf>(&radiance)) {
    light.strength = *color * float(scale);
  } else {
    light.strength = Colorf{1, 1, 1} * float(scale);
    light.texture = {radiance, parameters.texture("radiance")->location};
  }
  if (const Colorf& l = light.strength; !std::isfinite(l.r) || !std::isfinite(l.g) || !std::isfinite(l.b))
    throw InputError(parameters.location("scale"), "'radiance' times 'scale' is more than a float can hold");
  return light;
}

void add_light(const Object& description, const std::filesystem::path& directory, Lights& lights,
               std::vector<UnreadKey>& unread) {
  const auto* maker = std::find_if(std::begin(makers), std::end(makers), [&](const Maker& candidate) {
    return candidate.plugin.name == description.type;
  });
  if (maker == std::end(makers)) throw unknown_plugin(description, light_plugins());
  const std::string name = description.name.empty()
                               ? fmt::format("{} {}", description.type, lights.count() + 1)
                               : description.name;
  maker->add({description, directory, unread, name}, lights);
}

}  // namespace etendue

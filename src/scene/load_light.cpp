#include "scene/load_light.h"

#include <fmt/format.h>
#include <utility>

namespace etendue {

namespace {

const Plugin area_plugin{"light",
                         std::string(area_light_name),
                         "The shape shines from its front side, alike in all directions.",
                         {{"radiance", Parameter::Type::color, "1", "W/(m^2 sr)", "Emitted radiance"}},
                         {}};

}  // namespace

bool is_light(const Object& object) { return object.family == "luminaire" || object.family == "emitter"; }

const std::vector<Plugin>& light_plugins() {
  static const std::vector<Plugin> plugins{area_plugin,        point_plugin,        spot_plugin,
                                           directional_plugin, distant_disk_plugin, constant_plugin,
                                           envmap_plugin};
  return plugins;
}

Colorf area_light_radiance(const Object& description, std::vector<UnreadKey>& unread) {
  return nonnegative_color(Parameters(description, area_plugin, unread), "radiance");
}

void add_light(const Object& description, const std::filesystem::path& directory, Lights& lights,
               std::vector<UnreadKey>& unread) {
  const std::string name = description.name.empty()
                               ? fmt::format("{} {}", description.type, lights.count() + 1)
                               : description.name;
  const std::string& type = description.type;
  if (type == point_plugin.name) {
    const PointLight light = make_point_light(description, unread);
    lights.add<PointLights>(light.intensity, name, light.position);
  } else if (type == spot_plugin.name) {
    const SpotLight light = make_spot_light(description, unread);
    lights.add<SpotLights>(light.intensity, name, light);
  } else if (type == directional_plugin.name) {
    const DirectionalLight light = make_directional_light(description, unread);
    lights.add<DirectionalLights>(light.irradiance, name, light.direction);
  } else if (type == distant_disk_plugin.name || type == constant_plugin.name) {
    const DistantDisk light = type == constant_plugin.name ? make_constant_environment(description, unread)
                                                           : make_distant_disk(description, unread);
    lights.add<DistantDiskLights>(light.radiance, name, light);
  } else if (type == envmap_plugin.name) {
    EnvmapLight light = make_envmap_light(description, directory, unread);
    const Colorf scale{light.scale, light.scale, light.scale};
    lights.add<EnvmapLights>(scale, name, std::move(light.map), light.world_from_map);
  } else {
    throw unknown_plugin(description, light_plugins());
  }
}

}  // namespace etendue

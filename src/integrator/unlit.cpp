#include "integrator/unlit.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

namespace {

using Type = Parameter::Type;

const Plugin& plugin_named(std::string_view name) {
  const auto& plugins = unlit_plugins();
  return *std::find_if(plugins.begin(), plugins.end(), [&](const Plugin& p) { return p.name == name; });
}

/// With the parameters' defaults.
IntegratorSettings defaults_of(const Plugin& plugin) {
  IntegratorSettings settings;
  settings.name = plugin.name;
  if (plugin.name == "normals") settings.kind = IntegratorKind::normals;
  if (plugin.name == "material") settings.kind = IntegratorKind::material;
  if (plugin.name == "simple") settings.kind = IntegratorKind::simple;
  if (plugin.name == "av") {
    settings.kind = IntegratorKind::visibility;
    settings.visibility = {.is_cosine_weighted = false, .background = 1};
  }
  if (plugin.name == "ao") {
    settings.kind = IntegratorKind::visibility;
    settings.visibility = {.is_cosine_weighted = true, .background = 0};
  }
  return settings;
}

}  // namespace

const std::vector<Plugin>& unlit_plugins() {
  static const std::vector<Plugin> plugins{
      {"integrator", "normals", "The shading normal's |x|, |y|, |z| as red, green, blue.", {}, {}},
      {"integrator",
       "av",
       "Average visibility: the share of the hemisphere in which nothing is near.",
       {{"length", Type::real, "", "m", "Nothing farther counts; without it, everything does"}},
       {}},
      {"integrator", "ao", "Ambient occlusion: as av, cosine-weighted, at any distance.", {}, {}},
      {"integrator", "material", "The BSDF's value between the camera and the shading normal.", {}, {}},
      {"integrator",
       "simple",
       "White surfaces under one point light of its own.",
       {{"position", Type::point, "", "m", "Where the light is", true},
        {"energy", Type::color, "", "W", "Its power", true}},
       {}}};
  return plugins;
}

bool is_unlit(std::string_view name) {
  const auto& plugins = unlit_plugins();
  return std::any_of(plugins.begin(), plugins.end(), [&](const Plugin& p) { return p.name == name; });
}

IntegratorSettings make_unlit(const Object& description, std::vector<UnreadKey>& unread) {
  const Plugin& plugin = plugin_named(description.type);
  const Parameters parameters(description, plugin, unread);
  IntegratorSettings settings = defaults_of(plugin);
  if (plugin.name == "av" && parameters.has("length")) {
    const double length = parameters.real("length");
    if (!(length > 0))
      throw InputError(parameters.location("length"),
                       fmt::format("'length' is {}; it must be positive", length),
                       "give the distance, in metres, up to which things hide the sky");
    settings.visibility.length = float(length);
  }
  if (plugin.name == "simple") {
    const Vec3<double> position = parameters.point("position");
    settings.simple = {{float(position.x), float(position.y), float(position.z)},
                       nonnegative_color(parameters, "energy")};
  }
  return settings;
}

IntegratorSettings unlit_from_name(std::string_view name) {
  const Plugin& plugin = plugin_named(name);
  for (const Parameter& parameter : plugin.parameters)
    if (parameter.is_required)
      throw InputError(fmt::format("--integrator {}: it needs '{}', which only a scene file can state", name,
                                   parameter.name));
  return defaults_of(plugin);
}

}  // namespace etendue

#include "integrator/unlit.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

namespace {

using Type = Parameter::Type;

/// What a name stands for, with the parameters' defaults.
struct UnlitIntegrator {
  Plugin plugin;
  IntegratorRules rules;
};

const std::vector<UnlitIntegrator>& unlit_integrators() {
  static const std::vector<UnlitIntegrator> rows{
      {{"integrator", "normals", "The shading normal's |x|, |y|, |z| as red, green, blue.", {}, {}},
       ShowNormals{}},
      {{"integrator",
        "av",
        "Average visibility: the share of the hemisphere in which nothing is near.",
        {{"length", Type::real, "", "m", "Nothing farther counts; without it, everything does"}},
        {}},
       VisibilityRules{.is_cosine_weighted = false, .background = 1}},
      {{"integrator", "ao", "Ambient occlusion: as av, cosine-weighted, at any distance.", {}, {}},
       VisibilityRules{.is_cosine_weighted = true, .background = 0}},
      {{"integrator", "material", "The BSDF's value between the camera and the shading normal.", {}, {}},
       ShowMaterial{}},
      {{"integrator",
        "simple",
        "White surfaces under one point light of its own.",
        {{"position", Type::point, "", "m", "Where the light is", true},
         {"energy", Type::color, "", "W", "Its power", true}},
        {}},
       SimpleLight{}}};
  return rows;
}

const UnlitIntegrator* find_unlit(std::string_view name) {
  const auto row =
      std::find_if(unlit_integrators().begin(), unlit_integrators().end(),
                   [&](const UnlitIntegrator& candidate) { return candidate.plugin.name == name; });
  return row == unlit_integrators().end() ? nullptr : &*row;
}

}  // namespace

const std::vector<Plugin>& unlit_plugins() {
  static const std::vector<Plugin> plugins = [] {
    std::vector<Plugin> made;
    for (const UnlitIntegrator& row : unlit_integrators()) made.push_back(row.plugin);
    return made;
  }();
  return plugins;
}

bool is_unlit(std::string_view name) { return find_unlit(name) != nullptr; }

IntegratorSettings make_unlit(const Object& description, std::vector<UnreadKey>& unread) {
  const UnlitIntegrator& row = *find_unlit(description.type);
  const Parameters parameters(description, row.plugin, unread);
  IntegratorSettings settings{row.plugin.name, row.rules};
  if (auto* visibility = std::get_if<VisibilityRules>(&settings.rules);
      visibility && row.plugin.name == "av" && parameters.has("length")) {
    const double length = parameters.real("length");
    if (!(length > 0))
      throw InputError(parameters.location("length"),
                       fmt::format("'length' is {}; it must be positive", length),
                       "give the distance, in metres, up to which things hide the sky");
    visibility->length = float(length);
  }
  if (auto* simple = std::get_if<SimpleLight>(&settings.rules)) {
    const Vec3<double> position = parameters.point("position");
    *simple = {{float(position.x), float(position.y), float(position.z)},
               nonnegative_color(parameters, "energy")};
  }
  return settings;
}

IntegratorSettings unlit_from_name(std::string_view name) {
  const UnlitIntegrator& row = *find_unlit(name);
  for (const Parameter& parameter : row.plugin.parameters)
    if (parameter.is_required)
      throw InputError(fmt::format("--integrator {}: it needs '{}', which only a scene file can state", name,
                                   parameter.name));
  return {row.plugin.name, row.rules};
}

}  // namespace etendue

#include "lightsampler/light_sampler.h"

#include <algorithm>

namespace etendue {

namespace {

struct NamedLightSampler {
  std::string_view name, meaning;
  LightSampler (*make)(const Lights&);
};

template <class Sampler>
LightSampler make(const Lights& lights) {
  return LightSampler(Sampler(lights));
}

constexpr NamedLightSampler light_samplers[]{
    {"uniform", "One light, all alike.", make<UniformLights>},
    {"power", "One light, in proportion to its power.", make<PowerLights>},
    {"all", "Every light: a light sample is one sample of each, added up.", make<AllLights>},
    {"tree",
     "One facet of a light, by what it may bring to the place: power, distance, and how both face each "
     "other, by a light tree.",
     make<TreeLights>},
};

const NamedLightSampler& row_named(std::string_view name) {
  const auto* found = std::find_if(std::begin(light_samplers), std::end(light_samplers),
                                   [&](const NamedLightSampler& row) { return row.name == name; });
  if (found == std::end(light_samplers)) throw unknown_plugin("light sampler", name, light_sampler_plugins());
  return *found;
}

}  // namespace

const std::vector<Plugin>& light_sampler_plugins() {
  static const std::vector<Plugin> plugins = [] {
    std::vector<Plugin> made;
    for (const NamedLightSampler& row : light_samplers)
      made.push_back({"light sampler", std::string(row.name), std::string(row.meaning), {}, {}});
    return made;
  }();
  return plugins;
}

std::string_view known_light_sampler(std::string_view name) { return row_named(name).name; }

std::int64_t facet_count(const Lights& lights) {
  std::int64_t facets = 0;
  for (std::int32_t light = 0; light < lights.count(); ++light) facets += lights.facet_count(light);
  return facets;
}

LightSampler make_light_sampler(std::string_view name, const Lights& lights) {
  const NamedLightSampler& row = row_named(name);
  // One facet leaves nothing to choose: the samples are the same but for rounding, without pilots and walks.
  if (row.name == "tree" && facet_count(lights) == 1) return make<UniformLights>(lights);
  return row.make(lights);
}

}  // namespace etendue

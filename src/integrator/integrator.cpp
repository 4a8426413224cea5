#include "integrator/integrator.h"

#include "integrator/unlit.h"

#include <array>
#include <fmt/format.h>
#include <optional>

namespace etendue {

namespace {

using Type = Parameter::Type;

constexpr PathRules direct_rules(DirectLight direct_light) { return {.direct_light = direct_light}; }
constexpr PathRules path_rules(DirectLight direct_light) {
  return {.direct_light = direct_light, .most_vertices = PathRules::unlimited};
}
constexpr PathRules every_light_rules() {
  return {.direct_light = DirectLight::lights, .is_every_light = true};
}
constexpr PathRules whitted_rules() {
  return {.direct_light = DirectLight::lights, .most_vertices = PathRules::unlimited, .is_dirac_only = true};
}

/// What a name stands for.
struct Meaning {
  std::string_view name;
  std::string_view canonical;  ///< The name that says it whatever the dialect.
  PathRules rules;
};

constexpr std::array meanings{
    Meaning{"light", "light", direct_rules(DirectLight::lights)},
    Meaning{"area", "light", direct_rules(DirectLight::lights)},
    Meaning{"direct_ems", "light", direct_rules(DirectLight::lights)},
    Meaning{"direct", "direct", direct_rules(DirectLight::bsdf)},
    Meaning{"direct_mats", "direct", direct_rules(DirectLight::bsdf)},
    Meaning{"average", "average", direct_rules(DirectLight::half)},
    Meaning{"mis", "mis", direct_rules(DirectLight::balance)},
    Meaning{"direct_mis", "mis", direct_rules(DirectLight::balance)},
    Meaning{"every_light", "every_light", every_light_rules()},
    Meaning{"whitted", "whitted", whitted_rules()},
    Meaning{"path", "path_mis", path_rules(DirectLight::balance)},
    Meaning{"path_mis", "path_mis", path_rules(DirectLight::balance)},
    Meaning{"mipath", "path_mis", path_rules(DirectLight::balance)},
    Meaning{"path_ems", "path_ems", path_rules(DirectLight::lights)},
    Meaning{"path_mats", "path_mats", path_rules(DirectLight::bsdf)},
};

const Meaning* find(std::string_view name) {
  for (const Meaning& meaning : meanings)
    if (meaning.name == name) return &meaning;
  return nullptr;
}

IntegratorSettings settings_of(const Meaning& meaning) {
  return {.name = meaning.canonical, .kind = IntegratorKind::path, .rules = meaning.rules};
}

const Parameter heuristic_parameter{"heuristic", Type::text, "balance", "", "balance or power (exponent 2)"};

/// McGill's integrator of the dialect nori, with numbers of samples of its own.
const Plugin sampling_direct_plugin{
    "integrator",
    "direct",
    "BRDF sampling: each sample takes one direction from the BSDF. In the dialect nori, by the method and "
    "with "
    "the numbers of samples that its keys say; in nori-eth, every_light.",
    {{"samplingMethod", Type::text, "brdf", "", "brdf, emitter or mis"},
     {"emitterSamples", Type::integer, "1", "", "Light samples for each camera ray"},
     {"brdfSamples", Type::integer, "1", "", "BSDF samples for each camera ray"},
     heuristic_parameter},
    {}};

DirectLight heuristic_of(const Parameters& parameters) {
  const std::string heuristic = parameters.text("heuristic");
  if (heuristic != "balance" && heuristic != "power")
    throw InputError(parameters.location("heuristic"), "unknown heuristic '" + heuristic + "'",
                     known_names(heuristic, {"balance", "power"}));
  return heuristic == "power" ? DirectLight::power : DirectLight::balance;
}

int sample_count(const Parameters& parameters, std::string_view name) {
  const int count = parameters.integer(name);
  constexpr int most = 1 << 16;
  if (count < 0 || count > most)
    throw InputError(parameters.location(name),
                     fmt::format("'{}' is {}; it must be from 0 to {}", name, count, most));
  return count;
}

IntegratorSettings make_sampling_direct(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, sampling_direct_plugin, unread);
  const std::string method = parameters.text("samplingMethod");
  const int light_samples = sample_count(parameters, "emitterSamples"),
            bsdf_samples = sample_count(parameters, "brdfSamples");
  const DirectLight heuristic = heuristic_of(parameters);
  const auto settings = [&](std::string_view name, DirectLight direct_light) {
    IntegratorSettings made{.name = name, .kind = IntegratorKind::path, .rules = direct_rules(direct_light)};
    made.rules.light_samples = direct_light == DirectLight::bsdf ? 0 : light_samples;
    made.rules.bsdf_samples = direct_light == DirectLight::lights ? 0 : bsdf_samples;
    if (made.rules.light_samples + made.rules.bsdf_samples == 0)
      throw InputError(
          parameters.location(direct_light == DirectLight::bsdf ? "brdfSamples" : "emitterSamples"),
          fmt::format("samplingMethod '{}' with 0 samples: the image would be black", method));
    return made;
  };
  if (method == "emitter" || (method == "mis" && bsdf_samples == 0))
    return settings("light", DirectLight::lights);
  if (method == "brdf" || (method == "mis" && light_samples == 0))
    return settings("direct", DirectLight::bsdf);
  if (method == "mis") return settings("mis", heuristic);
  throw InputError(parameters.location("samplingMethod"), "unknown samplingMethod '" + method + "'",
                   known_names(method, {"brdf", "emitter", "mis"}));
}

Plugin plugin(std::string name, std::string meaning, std::vector<Parameter> parameters = {}) {
  return {"integrator", std::move(name), std::move(meaning), std::move(parameters), {}};
}

std::vector<Plugin> with_unlit(std::vector<Plugin> plugins) {
  plugins.insert(plugins.end(), unlit_plugins().begin(), unlit_plugins().end());
  return plugins;
}

}  // namespace

const std::vector<Plugin>& integrator_plugins() {
  static const std::vector<Plugin> plugins = with_unlit({
      plugin("light", "Area sampling: each sample takes one point on one light."),
      plugin("area", "Another name of light."),
      plugin("direct_ems", "Another name of light."),
      sampling_direct_plugin,
      plugin("direct_mats", "BRDF sampling: each sample takes one direction from the BSDF."),
      plugin("average", "Half of a light sample plus half of a BSDF sample."),
      plugin("mis", "A light sample and a BSDF sample, combined by multiple importance sampling.",
             {heuristic_parameter}),
      plugin("direct_mis", "Another name of mis.", {heuristic_parameter}),
      plugin("every_light", "Each sample takes one point on every light, and adds them up."),
      plugin("whitted", "Light samples, seen through mirrors and smooth dielectrics too."),
      plugin("path", "Another name of path_mis.", {heuristic_parameter}),
      plugin("path_ems", "Paths with any number of bounces; at each, direct light by light samples."),
      plugin("path_mats", "Paths with any number of bounces that find lights by chance."),
      plugin("path_mis",
             "Paths with any number of bounces; at each, direct light by light and BSDF samples, combined by "
             "multiple importance sampling.",
             {heuristic_parameter}),
      plugin("mipath", "Another name of path_mis.", {heuristic_parameter}),
  });
  return plugins;
}

std::string_view heuristic_name(DirectLight direct_light) {
  return direct_light == DirectLight::power ? "power" : direct_light == DirectLight::balance ? "balance" : "";
}

IntegratorSettings make_integrator(const Object& description, Dialect dialect,
                                   std::vector<UnreadKey>& unread) {
  if (is_unlit(description.type)) return make_unlit(description, unread);
  if (description.type == sampling_direct_plugin.name && dialect == Dialect::nori)
    return make_sampling_direct(description, unread);
  const Plugin* known = nullptr;
  for (const Plugin& candidate : integrator_plugins())
    if (candidate.name == description.type) known = &candidate;
  if (!known) throw unknown_plugin(description, integrator_plugins());
  std::string_view name = description.type;
  if (name == sampling_direct_plugin.name && dialect == Dialect::nori_eth) name = "every_light";
  Plugin described = *known;
  if (known->name == sampling_direct_plugin.name) described.parameters.clear();
  const Parameters parameters(description, described, unread);
  IntegratorSettings settings = settings_of(*find(name));
  if (parameters.has("heuristic")) settings.rules.direct_light = heuristic_of(parameters);
  return settings;
}

IntegratorSettings integrator_from_name(std::string_view name) {
  if (is_unlit(name)) return unlit_from_name(name);
  const Meaning* meaning = find(name);
  if (!meaning) throw unknown_plugin("integrator", name, integrator_plugins());
  return settings_of(*meaning);
}

std::string unseen_lights(const IntegratorSettings& integrator, int dirac_lights) {
  if (dirac_lights == 0 || !integrator.needs_lights() || integrator.rules.has_light_samples()) return "";
  return fmt::format(
      "{} samples no lights, so {} point, spot or directional light{} will not shine\n"
      "take light, mis, path_ems or path_mis",
      integrator.name, dirac_lights, dirac_lights == 1 ? "" : "s");
}

}  // namespace etendue

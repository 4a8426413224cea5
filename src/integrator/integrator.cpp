#include "integrator/integrator.h"

#include "integrator/unlit.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace etendue {

namespace {

using Type = Parameter::Type;

constexpr std::string_view heuristics_text = "balance, power (exponent 2), maximum, compensated or optimal";
const Parameter heuristic_parameter{"heuristic", Type::text, "balance", "", std::string(heuristics_text)};
const Parameter power_parameter{"heuristic", Type::text, "power", "", std::string(heuristics_text)};

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

/// The keys that a row's integrator takes: a heuristic, by default balance or power; numbers of samples.
enum class Keys { none, heuristic, power, sampling };

/// What a name stands for.
struct NamedPathIntegrator {
  std::string_view name;
  std::string_view canonical;  ///< The name that says it whatever the dialect.
  std::string_view meaning;    ///< Of other names than the canonical one, nothing.
  Keys keys;
  PathRules (*rules)(Heuristic heuristic);
};

PathRules light_rules(Heuristic) { return PathRules::direct(ByLights{}); }
PathRules direct_rules(Heuristic) { return PathRules::direct(ByBsdf{}); }
PathRules average_rules(Heuristic) { return PathRules::direct(ByBoth{Heuristic::average}); }
PathRules mis_rules(Heuristic heuristic) { return PathRules::direct(ByBoth{heuristic}); }
PathRules every_light_rules(Heuristic) { return PathRules::direct(ByLights{{.sampler = "all"}}); }
PathRules whitted_rules(Heuristic) { return PathRules::whitted({}); }
PathRules path_ems_rules(Heuristic) { return PathRules::paths(ByLights{}); }
PathRules path_mats_rules(Heuristic) { return PathRules::paths(ByBsdf{}); }
PathRules path_mis_rules(Heuristic heuristic) { return PathRules::paths(ByBoth{heuristic}); }
/// What has been measured to be best, docs/light_sampling.md. \param light_samples at each vertex
ByBoth best_rules(Heuristic heuristic, int light_samples) {
  return {.heuristic = heuristic,
          .lights = {.count = light_samples,
                     .sampler = "tree",
                     .candidates = 0,
                     .technique = LightTechnique::automatic},
          .only_where_glossy = true};
}
constexpr int best_outline_rays = 16;
PathRules path_rules(Heuristic heuristic) {
  constexpr float survival_factor = 2;
  return PathRules::paths(best_rules(heuristic, 1), survival_factor).with_outline_rays(best_outline_rays);
}
PathRules direct_light_rules(Heuristic heuristic) {
  return PathRules::direct(best_rules(heuristic, 4)).with_outline_rays(best_outline_rays);
}

constexpr NamedPathIntegrator path_integrators[]{
    {"path", "path",
     "Paths with any number of bounces, with the best that has been measured of light samples.", Keys::power,
     path_rules},
    {"direct_light", "direct_light", "Direct light, with the best that has been measured of light samples.",
     Keys::power, direct_light_rules},
    {"light", "light",
     "Area sampling: each sample takes one point on one light. Its variance has no bound where a lit "
     "surface meets the light.",
     Keys::none, light_rules},
    {"area", "light", "", Keys::none, light_rules},
    {"direct_ems", "light", "", Keys::none, light_rules},
    {"direct", "direct", "", Keys::sampling, direct_rules},
    {"direct_mats", "direct", "BRDF sampling: each sample takes one direction from the BSDF.", Keys::none,
     direct_rules},
    {"average", "average", "Half of a light sample plus half of a BSDF sample.", Keys::none, average_rules},
    {"mis", "mis", "A light sample and a BSDF sample, combined by multiple importance sampling.",
     Keys::heuristic, mis_rules},
    {"direct_mis", "mis", "", Keys::heuristic, mis_rules},
    {"every_light", "every_light", "Each sample takes one point on every light, and adds them up.",
     Keys::none, every_light_rules},
    {"whitted", "whitted", "Light samples, seen through mirrors and smooth dielectrics too.", Keys::none,
     whitted_rules},
    {"path_ems", "path_ems",
     "Paths with any number of bounces; at each, direct light by light samples. The variance has no bound "
     "where lit or shining surfaces meet a light.",
     Keys::none, path_ems_rules},
    {"path_mats", "path_mats", "Paths with any number of bounces that find lights by chance.", Keys::none,
     path_mats_rules},
    {"path_mis", "path_mis",
     "Paths with any number of bounces; at each, direct light by light and BSDF samples, combined by "
     "multiple importance sampling.",
     Keys::heuristic, path_mis_rules},
    {"mipath", "path_mis", "", Keys::heuristic, path_mis_rules},
};

Plugin plugin_of(const NamedPathIntegrator& row) {
  if (row.keys == Keys::sampling) return sampling_direct_plugin;
  Plugin plugin{"integrator", std::string(row.name), std::string(row.meaning), {}, {}};
  if (row.meaning.empty()) plugin.meaning = fmt::format("Another name of {}.", row.canonical);
  if (row.keys == Keys::heuristic) plugin.parameters = {heuristic_parameter};
  if (row.keys == Keys::power) plugin.parameters = {power_parameter};
  return plugin;
}

/// Null for a name that no row has.
const NamedPathIntegrator* find_path_integrator(std::string_view name) {
  const auto* row =
      std::find_if(std::begin(path_integrators), std::end(path_integrators),
                   [&](const NamedPathIntegrator& candidate) { return candidate.name == name; });
  return row == std::end(path_integrators) ? nullptr : row;
}

Heuristic heuristic_named(std::string_view name, const Location& where) {
  if (name == "balance") return Heuristic::balance;
  if (name == "power") return Heuristic::power;
  if (name == "maximum") return Heuristic::maximum;
  if (name == "compensated") return Heuristic::compensated;
  if (name == "optimal") return Heuristic::optimal;
  throw InputError(where, fmt::format("unknown heuristic '{}'", name),
                   known_names(name, {"balance", "power", "maximum", "compensated", "optimal"}));
}
Heuristic heuristic_of(const Parameters& parameters) {
  return heuristic_named(parameters.text("heuristic"), parameters.location("heuristic"));
}

constexpr std::string_view samplers_of_lights = "take path, direct_light, light, mis, path_ems or path_mis";

/// \param what is asked of them. Throws InputError where the integrator takes none.
const LightSamples& light_samples_of(const IntegratorSettings& integrator, std::string_view what) {
  const PathRules* rules = integrator.path_rules();
  if (!rules || !rules->light_samples())
    throw InputError(fmt::format("{}: the integrator {} takes no samples of the lights\n{}", what,
                                 integrator.name, samplers_of_lights));
  return *rules->light_samples();
}

void check_range(int number, std::string_view what, int most) {
  if (number < 1 || number > most)
    throw InputError(fmt::format("{} {}; expected from 1 to {}", number, what, most));
}

constexpr int most_samples_of_a_kind = 1 << 16;  ///< Light samples, or BSDF samples, of the first vertex.

int sample_count(const Parameters& parameters, std::string_view name) {
  const int count = parameters.integer(name);
  if (count < 0 || count > most_samples_of_a_kind)
    throw InputError(parameters.location(name),
                     fmt::format("'{}' is {}; it must be from 0 to {}", name, count, most_samples_of_a_kind));
  return count;
}

std::string_view heuristic_text(Heuristic heuristic) {
  switch (heuristic) {
    case Heuristic::average:
      return "average";
    case Heuristic::balance:
      return "balance";
    case Heuristic::power:
      return "power";
    case Heuristic::maximum:
      return "maximum";
    case Heuristic::compensated:
      return "compensated";
    case Heuristic::optimal:
      return "optimal";
  }
  return "";
}

std::string rules_text(const LightSamples& lights) {
  std::string text = fmt::format(" light_samples={} sampler={}", lights.count, lights.sampler);
  if (lights.later_count > 0) text += fmt::format(" later_light_samples={}", lights.later_count);
  if (lights.candidates == 0) text += " candidates=by_scene";
  if (lights.candidates > 1) text += fmt::format(" candidates={}", lights.candidates);
  if (lights.glossy_candidates > 0) text += fmt::format(" glossy_candidates={}", lights.glossy_candidates);
  if (lights.technique != LightTechnique::area)
    text += fmt::format(" technique={}", light_technique_name(lights.technique));
  return text;
}
std::string rules_text(const ByLights& by) { return rules_text(by.lights); }
std::string rules_text(const ByBsdf& by) { return fmt::format(" bsdf_samples={}", by.bsdf_samples); }
std::string rules_text(const ByBoth& by) {
  std::string text =
      fmt::format(" heuristic={}{} bsdf_samples={}{}", heuristic_text(by.heuristic), rules_text(by.lights),
                  by.bsdf_samples, by.only_where_glossy ? " only_where_glossy" : "");
  if (by.alpha != Colorf{0, 0, 0}) text += fmt::format(" alpha={},{},{}", by.alpha.r, by.alpha.g, by.alpha.b);
  return text;
}
std::string rules_text(const PathRules& rules) {
  std::string text = std::visit([](const auto& by) { return rules_text(by); }, rules.direct_light());
  if (rules.outline_rays() > 0) text += fmt::format(" outline_rays={}", rules.outline_rays());
  if (rules.survival_factor() != 1) text += fmt::format(" survival_factor={}", rules.survival_factor());
  return text;
}
std::string rules_text(const ShowNormals&) { return ""; }
std::string rules_text(const ShowMaterial&) { return ""; }
std::string rules_text(const VisibilityRules& rules) {
  return fmt::format(" cosine_weighted={} length={} background={}", rules.is_cosine_weighted, rules.length,
                     rules.background);
}
std::string rules_text(const SimpleLight& light) {
  return fmt::format(" position={},{},{} energy={},{},{}", light.position.x, light.position.y,
                     light.position.z, light.energy.r, light.energy.g, light.energy.b);
}
std::string rules_text(const SingleRays& rules) { return " plugin=" + rules.plugin; }

IntegratorSettings make_sampling_direct(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, sampling_direct_plugin, unread);
  const std::string method = parameters.text("samplingMethod");
  const LightSamples light_samples{.count = sample_count(parameters, "emitterSamples")};
  const int bsdf_samples = sample_count(parameters, "brdfSamples");
  const Heuristic heuristic = heuristic_of(parameters);
  if (method != "brdf" && method != "emitter" && method != "mis")
    throw InputError(parameters.location("samplingMethod"), "unknown samplingMethod '" + method + "'",
                     known_names(method, {"brdf", "emitter", "mis"}));
  const bool has_lights = method != "brdf" && light_samples.count > 0,
             has_bsdf = method != "emitter" && bsdf_samples > 0;
  if (has_lights && has_bsdf)
    return {"mis", PathRules::direct(ByBoth{heuristic, light_samples, bsdf_samples})};
  if (has_lights) return {"light", PathRules::direct(ByLights{light_samples})};
  if (has_bsdf) return {"direct", PathRules::direct(ByBsdf{bsdf_samples})};
  throw InputError(parameters.location(method == "emitter" ? "emitterSamples" : "brdfSamples"),
                   fmt::format("samplingMethod '{}' with 0 samples: the image would be black", method));
}

}  // namespace

const std::vector<Plugin>& integrator_plugins() {
  static const std::vector<Plugin> plugins = [] {
    std::vector<Plugin> made;
    for (const NamedPathIntegrator& row : path_integrators) made.push_back(plugin_of(row));
    made.insert(made.end(), unlit_plugins().begin(), unlit_plugins().end());
    return made;
  }();
  return plugins;
}

std::string_view IntegratorSettings::light_sampler() const {
  const PathRules* paths = path_rules();
  return paths && paths->light_samples() ? paths->light_samples()->sampler : "";
}

std::string_view IntegratorSettings::light_technique() const {
  const PathRules* paths = path_rules();
  return paths && paths->light_samples() ? light_technique_name(paths->light_samples()->technique) : "";
}

std::string_view heuristic_name(const IntegratorSettings& integrator) {
  const PathRules* rules = integrator.path_rules();
  return rules && rules->needs_both_pdfs() ? heuristic_text(*rules->heuristic()) : "";
}

std::string describe(const IntegratorSettings& integrator) {
  return std::string(integrator.name) +
         std::visit([](const auto& rules) { return rules_text(rules); }, integrator.rules);
}

IntegratorSettings make_integrator(const Object& description, Dialect dialect,
                                   std::vector<UnreadKey>& unread) {
  if (is_unlit(description.type)) return make_unlit(description, unread);
  const NamedPathIntegrator* row = find_path_integrator(description.type);
  if (!row) throw unknown_plugin(description, integrator_plugins());
  if (row->keys == Keys::sampling && dialect == Dialect::nori)
    return make_sampling_direct(description, unread);
  // In the other dialects this one takes no keys, and in one of them it means another.
  if (row->keys == Keys::sampling)
    row = find_path_integrator(dialect == Dialect::nori_eth ? "every_light" : "direct_mats");
  Plugin plugin = plugin_of(*row);
  plugin.name = description.type;
  const Parameters parameters(description, plugin, unread);
  return {row->canonical,
          row->rules(plugin.parameters.empty() ? Heuristic::balance : heuristic_of(parameters))};
}

IntegratorSettings integrator_from_name(std::string_view name) {
  if (is_unlit(name)) return unlit_from_name(name);
  const NamedPathIntegrator* row = find_path_integrator(name);
  if (!row) throw unknown_plugin("integrator", name, integrator_plugins());
  return {row->canonical, row->rules(row->keys == Keys::power ? Heuristic::power : Heuristic::balance)};
}

IntegratorSettings with_light_sampler(const IntegratorSettings& integrator, std::string_view light_sampler) {
  const std::string_view name = known_light_sampler(light_sampler);
  LightSamples lights = light_samples_of(integrator, fmt::format("light sampler '{}'", name));
  lights.sampler = name;
  // These rules may have a name of their own: every_light is light with the sampler `all`.
  const PathRules rules = integrator.path_rules()->with_light_samples(lights);
  const auto* row = std::find_if(
      std::begin(path_integrators), std::end(path_integrators),
      [&](const NamedPathIntegrator& candidate) { return candidate.rules(Heuristic::balance) == rules; });
  return {row == std::end(path_integrators) ? integrator.name : row->canonical, rules};
}

IntegratorSettings with_light_technique(const IntegratorSettings& integrator, std::string_view technique) {
  const LightTechnique known = light_technique_from_name(technique);
  LightSamples lights = light_samples_of(integrator, fmt::format("technique '{}'", technique));
  lights.technique = known;
  return {integrator.name, integrator.path_rules()->with_light_samples(lights)};
}

IntegratorSettings with_candidates(const IntegratorSettings& integrator, int candidates) {
  LightSamples lights = light_samples_of(integrator, fmt::format("{} candidates", candidates));
  check_range(candidates, "candidates", 1 << 10);
  lights.candidates = candidates;
  lights.glossy_candidates = 0;
  return {integrator.name, integrator.path_rules()->with_light_samples(lights)};
}

IntegratorSettings with_shadow_rays(const IntegratorSettings& integrator, int shadow_rays) {
  LightSamples lights = light_samples_of(integrator, fmt::format("{} shadow rays", shadow_rays));
  check_range(shadow_rays, "shadow rays", most_samples_of_a_kind);
  if (lights.later_count == 0) lights.later_count = lights.count;
  lights.count = shadow_rays;
  return {integrator.name, integrator.path_rules()->with_light_samples(lights)};
}

IntegratorSettings with_bsdf_samples(const IntegratorSettings& integrator, int bsdf_samples) {
  const PathRules* rules = integrator.path_rules();
  if (!rules || !rules->has_bsdf_samples())
    throw InputError(
        fmt::format("{} BSDF samples: the integrator {} does not look for light by samples of the BSDF\n"
                    "take path, direct_light, direct, mis, path_mats or path_mis",
                    bsdf_samples, integrator.name));
  check_range(bsdf_samples, "BSDF samples", most_samples_of_a_kind);
  return {integrator.name, rules->with_bsdf_samples(bsdf_samples)};
}

IntegratorSettings with_heuristic(const IntegratorSettings& integrator, std::string_view heuristic) {
  const Heuristic named = heuristic_named(heuristic, {});
  if (heuristic_name(integrator).empty())
    throw InputError(
        fmt::format("weights by '{}': the integrator {} does not weigh light samples against BSDF samples\n"
                    "take path, direct_light, mis or path_mis",
                    heuristic, integrator.name));
  return {integrator.name, integrator.path_rules()->with_heuristic(named)};
}

IntegratorSettings with_alpha(const IntegratorSettings& integrator, const Colorf& alpha) {
  return {integrator.name, integrator.path_rules()->with_alpha(alpha)};
}

bool compensates_environments(const IntegratorSettings& integrator) {
  const PathRules* rules = integrator.path_rules();
  return rules && rules->heuristic() && *rules->heuristic() == Heuristic::compensated &&
         !rules->is_shared_only_where_glossy();
}

IntegratorSettings settled(const IntegratorSettings& integrator, const Lights& lights) {
  const PathRules* rules = integrator.path_rules();
  if (!has_open_light_budget(integrator)) return integrator;
  const std::int64_t facets = facet_count(lights);
  // Where the cut of a tile holds each facet by itself, points stay better distributed without a choice among
  // candidates than it could make them, unless lobes are narrow.
  const bool are_all_in_cut = facets <= LightCut::most_clusters;
  constexpr int several = 8, many = 16, fewest_glossy = 4;
  constexpr std::int64_t swarm = 1 << 16;  // Of facets: there a shadow ray takes as long as many candidates.
  const int candidates = are_all_in_cut ? 1 : facets <= swarm ? several : many;
  return with_light_budget(integrator, {.light_samples = rules->light_count(0),
                                        .candidates = candidates,
                                        .glossy_candidates = std::max(candidates, fewest_glossy),
                                        .bsdf_samples = rules->bsdf_samples(0)});
}

LightBudget light_budget(const IntegratorSettings& integrator) {
  const PathRules& rules = *integrator.path_rules();
  return {rules.light_count(0), rules.candidates(0), rules.glossy_candidates(0), rules.bsdf_samples(0)};
}

bool has_open_light_budget(const IntegratorSettings& integrator) {
  const PathRules* rules = integrator.path_rules();
  return rules && rules->light_samples() && rules->light_samples()->candidates == 0;
}

IntegratorSettings with_light_budget(const IntegratorSettings& integrator, const LightBudget& budget) {
  LightSamples samples = light_samples_of(integrator, "a budget of light samples");
  if (samples.later_count == 0) samples.later_count = samples.count;
  samples.count = budget.light_samples;
  samples.candidates = budget.candidates;
  samples.glossy_candidates = budget.glossy_candidates;
  const PathRules rules = integrator.path_rules()->with_light_samples(samples);
  return {integrator.name, rules.has_bsdf_samples() ? rules.with_bsdf_samples(budget.bsdf_samples) : rules};
}

LightSampler light_sampler_for(const IntegratorSettings& integrator, const Lights& lights) {
  const std::string_view name = integrator.light_sampler();
  return make_light_sampler(name.empty() ? LightSamples{}.sampler : name, lights);
}

std::string unseen_lights(const IntegratorSettings& integrator, int dirac_lights) {
  if (dirac_lights == 0 || !integrator.needs_lights() || integrator.path_rules()->light_samples()) return "";
  return fmt::format(
      "{} samples no lights, so {} point, spot or directional light{} will not shine\n"
      "{}",
      integrator.name, dirac_lights, dirac_lights == 1 ? "" : "s", samplers_of_lights);
}

}  // namespace etendue

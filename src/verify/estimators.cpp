#include "verify/estimators.h"

#include "base/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <sstream>

namespace etendue {
namespace {

constexpr std::int32_t most_lights_for_all = 16;

constexpr std::string_view direct_estimators[]{
    "direct",
    "light",
    "light --light-sampler power --technique solid_angle",
    "light --light-sampler tree --technique projected",
    "light --light-sampler tree --technique ltc",
    "light --light-sampler power --candidates 8",
    "every_light",
    "average",
    "mis",
    "mis --light-sampler power --technique solid_angle --weights power",
    "mis --light-sampler tree --technique projected",
    "direct_light",
};
constexpr std::string_view path_estimators[]{
    "path_mats",
    "path_ems",
    "path_ems --light-sampler power --technique solid_angle",
    "path_ems --light-sampler tree --technique projected",
    "path_ems --light-sampler power --candidates 8",
    "path_ems --light-sampler all",
    "path_mis",
    "path_mis --light-sampler power --technique solid_angle --weights power",
    "path_mis --light-sampler tree --technique ltc",
    "path",
};
constexpr std::string_view whitted_estimators[]{
    "whitted",
    "whitted --light-sampler power --technique solid_angle",
    "whitted --light-sampler tree --technique projected",
    "whitted --light-sampler power --candidates 8",
    "whitted --light-sampler all",
};

std::span<const std::string_view> names_for(PathLength length) {
  switch (length) {
    case PathLength::one_vertex:
      return direct_estimators;
    case PathLength::unlimited:
      return path_estimators;
    case PathLength::through_diracs:
      break;
  }
  return whitted_estimators;
}

IntegratorSettings integrator_of(const std::string& name) {
  std::istringstream words(name);
  std::string word, value;
  words >> word;
  IntegratorSettings integrator = integrator_from_name(word);
  while (words >> word) {
    if (!(words >> value)) throw InputError(fmt::format("'{}': {} needs a value", name, word));
    if (word == "--light-sampler")
      integrator = with_light_sampler(integrator, value);
    else if (word == "--technique")
      integrator = with_light_technique(integrator, value);
    else if (word == "--weights")
      integrator = with_heuristic(integrator, value);
    else if (word == "--candidates" || word == "--shadow-rays") {
      int number = 0;
      std::istringstream(value) >> number;
      integrator =
          word == "--candidates" ? with_candidates(integrator, number) : with_shadow_rays(integrator, number);
    } else {
      const std::vector<std::string> known{"--light-sampler", "--technique", "--weights", "--candidates",
                                           "--shadow-rays"};
      throw InputError({}, fmt::format("unknown option '{}' of an integrator", word),
                       known_names(word, known));
    }
  }
  return integrator;
}

bool has_option(std::string_view name, std::string_view option) {
  return name.find(option) != std::string_view::npos;
}

/// Why an estimator does not apply to the scene; none where it does.
std::optional<std::string> reason_against(const Scene& scene, std::string_view name,
                                          const IntegratorSettings& integrator) {
  const Lights& lights = scene.lights;
  if (!integrator.path_rules()->light_samples() && lights.dirac_count() > 0)
    return "no ray meets the scene's point, spot or directional lights";
  const bool has_surfaces = lights.dirac_count() + lights.infinite_count() < lights.count();
  // Light from everywhere has no surface, but its directions go by the cosine where they can.
  if (has_option(name, "--technique") && !has_surfaces &&
      !(has_option(name, "projected") && lights.infinite_count() > 0))
    return "the scene's lights have no surface to sample in another way";
  if (has_option(name, "ltc") && !scene.materials.lobes().have_any()) return "no surface is glossy";
  const bool takes_all = integrator.light_sampler() == "all";
  if (takes_all && lights.count() > most_lights_for_all)
    return fmt::format("{} lights, each sampled by each sample, take too long", lights.count());
  return std::nullopt;
}

}  // namespace

std::string_view quantity_of(const IntegratorSettings& integrator) {
  const PathRules* rules = integrator.path_rules();
  if (!rules) return "";
  switch (rules->length()) {
    case PathLength::one_vertex:
      return "direct light";
    case PathLength::unlimited:
      return "light of all bounces";
    case PathLength::through_diracs:
      break;
  }
  return "direct light, also through mirrors and smooth glass";
}

Estimators estimators_of(const Scene& scene, const IntegratorSettings& own) {
  if (quantity_of(own).empty())
    throw InputError(
        fmt::format("the integrator {} estimates no light that another one could\nname one that "
                    "does: --integrators light,mis or --integrators path_ems,path_mis",
                    own.name));
  Estimators estimators;
  const IntegratorSettings settled_own = settled(own, scene.lights);
  bool has_own = false;
  for (const std::string_view name : names_for(own.path_rules()->length())) {
    const IntegratorSettings integrator = settled(integrator_of(std::string(name)), scene.lights);
    if (const std::optional<std::string> reason = reason_against(scene, name, integrator)) {
      estimators.left_out.push_back({std::string(name), *reason});
      continue;
    }
    has_own = has_own || *integrator.path_rules() == *settled_own.path_rules();
    estimators.all.push_back({std::string(name), integrator});
  }
  if (!has_own && !reason_against(scene, own.name, settled_own))
    estimators.all.push_back({fmt::format("{} (as the file has it)", own.name), settled_own});
  return estimators;
}

Estimators estimators_named(const Scene& scene, std::span<const std::string> names, std::size_t least) {
  if (names.size() < least)
    throw InputError("--integrators: one has nothing to agree with\nname two or more: light,mis");
  Estimators estimators;
  for (const std::string& name : names) {
    const IntegratorSettings integrator = settled(integrator_of(name), scene.lights);
    if (quantity_of(integrator).empty())
      throw InputError(fmt::format("--integrators: {} estimates no light", name));
    const std::string_view first =
        estimators.all.empty() ? quantity_of(integrator) : quantity_of(estimators.all.front().integrator);
    if (quantity_of(integrator) != first)
      throw InputError(fmt::format("--integrators: {} shows {}, {} shows {}: they need not agree",
                                   names.front(), first, name, quantity_of(integrator)));
    if (!integrator.path_rules()->light_samples() && scene.lights.dirac_count() > 0)
      throw InputError(
          fmt::format("--integrators: {} samples no lights, and no ray meets the scene's point, spot "
                      "or directional lights",
                      name));
    estimators.all.push_back({name, integrator});
  }
  return estimators;
}

}  // namespace etendue

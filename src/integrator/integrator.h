// Which integrator, with its parameters: chosen once a render, by name.
//
// To add one: if it is a way to trace paths, give it a row with its PathRules in the table in integrator.cpp.
// Otherwise write integrator/NAME.h as a list of stages, a struct of what it is told in unlit_rules.h, its
// row in unlit.cpp; add the struct to IntegratorRules, and the compiler asks for its call in
// run_integrator.h.
#pragma once

#include "integrator/path_rules.h"
#include "integrator/unlit_rules.h"
#include "lightsampler/light_sampler.h"
#include "scenefile/parameters.h"

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace etendue {

using IntegratorRules =
    std::variant<PathRules, ShowNormals, VisibilityRules, ShowMaterial, SimpleLight, SingleRays>;

struct IntegratorSettings {
  std::string_view name = "light";  ///< Of those that integrator_from_name knows.
  IntegratorRules rules = PathRules::direct(ByLights{});

  /// Null of those that trace no paths.
  const PathRules* path_rules() const { return std::get_if<PathRules>(&rules); }
  bool needs_lights() const { return path_rules() != nullptr; }
  /// How lights are chosen; empty where none are.
  std::string_view light_sampler() const;
  /// Where on a light its samples lie; empty where none are.
  std::string_view light_technique() const;
};

const std::vector<Plugin>& integrator_plugins();
/// "balance", "power" and so on; empty where weights do not depend on densities.
std::string_view heuristic_name(const IntegratorSettings& integrator);

/// The name and all rules, on one line: "mis heuristic=power light_samples=3 sampler=power bsdf_samples=2".
std::string describe(const IntegratorSettings& integrator);

/// From the scene file, where some names mean another thing in each generation of the family: see
/// docs/scene_format.md. Throws InputError with the known names.
IntegratorSettings make_integrator(const Object& description, Dialect dialect,
                                   std::vector<UnreadKey>& unread);
/// From the command line: a name, its parameters at their defaults. `direct` is BRDF sampling.
IntegratorSettings integrator_from_name(std::string_view name);

/// The same with another light sampler, by the name that these rules have. Throws InputError for an unknown
/// one, and where the integrator samples no lights.
IntegratorSettings with_light_sampler(const IntegratorSettings& integrator, std::string_view light_sampler);
/// The same with each light sample of the first vertex one of so many candidates, 1 to 1024. Throws
/// InputError for other numbers, and where the integrator samples no lights.
IntegratorSettings with_candidates(const IntegratorSettings& integrator, int candidates);
/// The same with so many light samples at the first vertex, 1 to 65536; those behind take as many as before.
/// Throws InputError for other numbers, and where the integrator samples no lights.
IntegratorSettings with_shadow_rays(const IntegratorSettings& integrator, int shadow_rays);
/// The same with so many BSDF samples at the first vertex, 1 to 65536, each with a path of its own behind it
/// where there are any. Throws InputError for other numbers, and where the integrator does not look for light
/// by BSDF samples.
IntegratorSettings with_bsdf_samples(const IntegratorSettings& integrator, int bsdf_samples);
/// The same with weights by a name that heuristic_name gives. Throws InputError for another name, and where
/// the weights of the integrator do not depend on densities.
IntegratorSettings with_heuristic(const IntegratorSettings& integrator, std::string_view heuristic);

/// The same with the coefficient of optimal weights, ByBoth::alpha; heuristic_name must say "optimal".
IntegratorSettings with_alpha(const IntegratorSettings& integrator, const Colorf& alpha);
/// Whether it finds all light from infinity by BSDF samples too, so that light samples may leave out where
/// they suffice: Lights::compensate_environments.
bool compensates_environments(const IntegratorSettings& integrator);

/// The same with light samples by another technique, of light_technique_from_name. Throws InputError for an
/// unknown one, and where the integrator samples no lights.
IntegratorSettings with_light_technique(const IntegratorSettings& integrator, std::string_view technique);

/// The same with what it leaves to the scene decided: candidates, by how many facets the lights have and
/// by whether surfaces are diffuse (docs/light_sampling.md).
IntegratorSettings settled(const IntegratorSettings& integrator, const Lights& lights);

/// What the first vertex of a path takes.
struct LightBudget {
  int light_samples = 1;
  int candidates = 1;         ///< Of which each light sample is one, where surfaces are diffuse.
  int glossy_candidates = 1;  ///< Where they are not; no fewer.
  int bsdf_samples = 1;       ///< Each, where there is a second vertex, with a path of its own.
  friend bool operator==(const LightBudget&, const LightBudget&) = default;
};
/// Of a settled integrator that samples lights.
LightBudget light_budget(const IntegratorSettings& integrator);
/// Whether it leaves its candidates to the scene: path and direct_light do.
bool has_open_light_budget(const IntegratorSettings& integrator);
/// The same with this budget; vertices behind the first take as many light samples as before. Throws
/// InputError where the integrator samples no lights.
IntegratorSettings with_light_budget(const IntegratorSettings& integrator, const LightBudget& budget);

/// Over the lights of a scene, which it may not outlive; where the integrator samples none, any.
LightSampler light_sampler_for(const IntegratorSettings& integrator, const Lights& lights);

/// A warning for where the integrator cannot see the Dirac lights (point, spot, directional) that a scene
/// has; else empty.
std::string unseen_lights(const IntegratorSettings& integrator, int dirac_lights);

}  // namespace etendue

// Which integrator, with its parameters: chosen once a render, by name.
//
// To add one: if it is a way to trace paths, give it its PathRules in the table in integrator.cpp. Otherwise
// write integrator/NAME.h as a list of stages, add its kind here, its name and its plugin description in
// integrator.cpp, and its call in run_integrator.h.
#pragma once

#include "integrator/path_rules.h"
#include "integrator/unlit_rules.h"
#include "scenefile/parameters.h"

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class IntegratorKind { path, normals, visibility, material, simple };

struct IntegratorSettings {
  std::string_view name = "light";  ///< Of those that integrator_from_name knows.
  IntegratorKind kind = IntegratorKind::path;
  PathRules rules;               ///< Of kind path.
  VisibilityRules visibility{};  ///< Of kind visibility.
  SimpleLight simple{};          ///< Of kind simple.

  bool needs_lights() const { return kind == IntegratorKind::path; }
};

const std::vector<Plugin>& integrator_plugins();
std::string_view heuristic_name(DirectLight direct_light);  ///< "balance", "power"; empty for the others.

/// From the scene file, where some names mean another thing in each generation of the family: see
/// docs/scene_format.md. Throws InputError with the known names.
IntegratorSettings make_integrator(const Object& description, Dialect dialect,
                                   std::vector<UnreadKey>& unread);
/// From the command line: a name, its parameters at their defaults. `direct` is BRDF sampling.
IntegratorSettings integrator_from_name(std::string_view name);

/// A warning for where the integrator cannot see the Dirac lights (point, spot, directional) that a scene
/// has; else empty.
std::string unseen_lights(const IntegratorSettings& integrator, int dirac_lights);

}  // namespace etendue

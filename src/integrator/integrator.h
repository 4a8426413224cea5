// Which integrator, with its parameters: chosen once a render, by name.
//
// To add one: write integrator/NAME.h as a list of stages, add its kind here, its name and its plugin
// description in integrator.cpp, and its call in run_integrator.h.
#pragma once

#include "integrator/mis_weights.h"
#include "scenefile/parameters.h"

#include <string_view>
#include <vector>

namespace etendue {

/// light (area sampling), direct (BRDF sampling), average (half of each), mis (both, weighted).
enum class IntegratorKind { light, direct, average, mis };

struct IntegratorSettings {
  IntegratorKind kind = IntegratorKind::light;
  Combination heuristic = Combination::balance;  ///< Of mis: balance or power.
};

const std::vector<Plugin>& integrator_plugins();
std::string_view integrator_name(IntegratorKind kind);
std::string_view heuristic_name(Combination heuristic);  ///< "balance" or "power".

/// From the scene file. Throws InputError with the known names.
IntegratorSettings make_integrator(const Object& description, std::vector<UnreadKey>& unread);
/// From the command line: a name, its parameters at their defaults; `area` is `light`.
IntegratorSettings integrator_from_name(std::string_view name);

}  // namespace etendue

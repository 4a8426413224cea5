// Which integrator, with its parameters: chosen once a render, by name.
#pragma once

#include <string_view>
#include <vector>

#include "integrator/mis_weights.h"
#include "scenefile/parameters.h"

namespace etendue {

/// light (area sampling), direct (BRDF sampling), average (half of each), mis (both, weighted).
enum class IntegratorKind { light, direct, average, mis };

struct IntegratorSettings {
  IntegratorKind kind = IntegratorKind::light;
  Combination heuristic = Combination::balance;  ///< Of mis: balance or power.
};

const std::vector<Plugin>& integrator_plugins();
std::string_view integrator_name(IntegratorKind kind);

/// From the scene file. Throws InputError with the known names.
IntegratorSettings make_integrator(const Object& description, std::vector<UnreadKey>& unread);
/// From the command line: a name, its parameters at their defaults; `area` is `light`.
IntegratorSettings integrator_from_name(std::string_view name);

}  // namespace etendue

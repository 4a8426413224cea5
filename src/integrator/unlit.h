// Integrators that look at shapes and materials, not at the scene's lights: normals, av, ao, material,
// simple.
#pragma once

#include "integrator/integrator.h"

#include <string_view>
#include <vector>

namespace etendue {

const std::vector<Plugin>& unlit_plugins();
bool is_unlit(std::string_view name);

/// From the scene file; `description.type` is one of them. Throws InputError for parameters out of range.
IntegratorSettings make_unlit(const Object& description, std::vector<UnreadKey>& unread);
/// From the command line. Throws InputError where parameters are needed.
IntegratorSettings unlit_from_name(std::string_view name);

}  // namespace etendue

// An integrator of the user's own in place of the program's: --plugin.
#pragma once

#include "render_options.h"

namespace etendue::app {

/// The plugin's integrator over this scene, which must stay where it is while it is in use; what it does not
/// see of the scene goes to `loaded.warnings`. Throws InputError where the file cannot be loaded, and for
/// options that only the program's integrators know.
IntegratorSettings integrator_of_plugin(const RenderOptions& options, LoadedScene& loaded);

}  // namespace etendue::app

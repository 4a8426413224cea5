#include "plugin.h"

#include "course/student_integrator.h"

#include <fmt/format.h>

namespace etendue::app {

namespace {

void check_options(const IntegratorOptions& options) {
  const bool is_asked_more = !options.light_sampler.empty() || !options.technique.empty() ||
                             !options.heuristic.empty() || options.candidates || options.shadow_rays ||
                             options.bsdf_samples;
  if (is_asked_more)
    throw InputError(
        "an integrator of --plugin does not know --light-sampler, --technique, --weights, --candidates, "
        "--shadow-rays and --bsdf-samples\nleave them out");
}

}  // namespace

IntegratorSettings integrator_of_plugin(const RenderOptions& options, LoadedScene& loaded) {
  check_options(options.integrator);
  const StudentModule module(options.plugin);
  auto integrator = std::make_shared<const StudentIntegrator>(module, options.integrator.name, loaded.scene,
                                                              loaded.places, loaded.integrator);
  const std::size_t unseen =
      std::size_t(loaded.scene.lights.count()) - integrator->scene().getLuminaires().size();
  if (unseen > 0)
    loaded.warnings.push_back(
        fmt::format("{} of the scene's lights are no surfaces, so the plugin {} does not see them", unseen,
                    options.plugin));
  return settings_of(std::move(integrator), loaded.scene.sampler);
}

}  // namespace etendue::app

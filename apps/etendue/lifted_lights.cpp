#include "lifted_lights.h"

#include "messages.h"

namespace etendue::app {

void lift_lights(const SceneDesc& description, const std::vector<Finding>& findings, bool is_quiet,
                 LoadSettings& loading, LoadedScene& loaded) {
  for (const Finding& finding : findings)
    loading.lifted.insert(loading.lifted.end(), finding.to_lift.begin(), finding.to_lift.end());
  if (loading.lifted.empty()) return;
  loading.lift = lift_of_lights(loaded.scene);
  if (!is_quiet)
    say("lights in one plane with another surface are taken to lie {:.2g} m before it\n", loading.lift);
  const SamplerKind sampler = loaded.scene.sampler;
  loaded = load_scene(description, loading);
  loaded.scene.sampler = sampler;
}

}  // namespace etendue::app

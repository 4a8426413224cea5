// Area sampling of the lights: the exercise's own method.
#pragma once

#include "integrator/light_stage.h"
#include "integrator/surface_stage.h"

namespace etendue {

/// Each sample: the emission that the camera sees, and one point on one light.
template <class F>
void light(const Scene& scene, SampleBlock& block, bool is_reordering) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block);
  add_emission<F>(scene, block);
  add_light_samples<F>(scene, block, Combination::alone, is_reordering);
}

}  // namespace etendue

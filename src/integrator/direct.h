// Directional (BRDF) sampling: the exercise's counterpart to area sampling.
#pragma once

#include "integrator/bsdf_stage.h"

namespace etendue {

/// Each sample: the emission that the camera sees, and the emission along one direction drawn from the BSDF.
template <class F>
void direct(const Scene& scene, SampleBlock& block) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block);
  add_emission<F>(scene, block);
  add_bsdf_samples<F>(scene, block, Combination::alone);
}

}  // namespace etendue

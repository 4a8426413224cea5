// Half of each method: the exercise's question whether averaging gives the best of both.
#pragma once

#include "integrator/bsdf_stage.h"
#include "integrator/light_stage.h"

namespace etendue {

/// Each sample: the emission that the camera sees, one light sample and one BSDF sample, each counted half.
template <class F>
void average(const Scene& scene, SampleBlock& block, bool is_reordering) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block);
  add_emission<F>(scene, block);
  add_light_samples<F>(scene, block, Combination::half, is_reordering);
  add_bsdf_samples<F>(scene, block, Combination::half);
}

}  // namespace etendue

// Multiple importance sampling: both methods, each weighted by how well it samples the point.
#pragma once

#include "integrator/bsdf_stage.h"
#include "integrator/light_stage.h"

namespace etendue {

/// Each sample: the emission that the camera sees, one light sample and one BSDF sample, weighted by
/// `heuristic`.
template <class F>
void mis(const Scene& scene, SampleBlock& block, Combination heuristic, bool is_reordering) {
  camera_rays<F>(scene, block);
  closest_hits<F>(scene, block);
  add_emission<F>(scene, block);
  add_light_samples<F>(scene, block, heuristic, is_reordering);
  add_bsdf_samples<F>(scene, block, heuristic);
}

}  // namespace etendue

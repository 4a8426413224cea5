// An integrator that is a function of one camera ray: one that was written by somebody else.
#pragma once

#include "integrator/camera_stage.h"
#include "integrator/unlit_rules.h"

namespace etendue {

/// Each sample: what the function gives for its camera ray.
template <class F>
void single_rays(const Scene& scene, SampleBlock& block, const SingleRays& rules) {
  camera_rays<F>(scene, block);
  const PathColumns& path = block.path;
  for (int i = 0; i < block.count; ++i)
    store_lanes(block.radiance, i,
                rules.radiance({load_ray<float>(path.ray, i),
                                path.ray.t_near[i],
                                path.ray.t_far[i],
                                {path.stream_lo[i], path.stream_hi[i], path.index[i]}}));
  block.counts.paths += block.count;
  block.counts.lanes += block.count;
  block.clock.finish(Stage::closest_hits);
}

}  // namespace etendue

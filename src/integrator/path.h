// The path integrators: every way to estimate direct light, and as many bounces as the rules say.
#pragma once

#include "integrator/bsdf_stage.h"
#include "integrator/hit_stage.h"
#include "integrator/light_stage.h"
#include "integrator/pilot_stage.h"
#include "integrator/seen_light_stage.h"

#include <memory>

namespace etendue {

/// What a path integrator works with, beside the block.
struct PathSetting {
  const Scene& scene;
  const LightSampler& light_sampler;
  const PathRules& rules;
  bool is_reordering;  ///< Aim shadow packets; off only to show that it changes nothing.
};

/// Takes the paths to their next vertex, adds the light that they meet there, and the light that comes
/// straight from lights.
template <class F>
void visit(const PathSetting& with, SampleBlock& block, int vertex) {
  const Scene& scene = with.scene;
  closest_hits<F>(scene, block, vertex == 0 ? Coherence::coherent : Coherence::incoherent);
  if (scene.medium) fly_through_medium<F>(scene, block, vertex);
  add_emission<F>(scene, with.light_sampler, block, with.rules, vertex);
  if (scene.lights.infinite_count() > 0)
    add_environment<F>(scene, with.light_sampler, block, with.rules, vertex);
  if (with.rules.is_scattering(vertex) && with.rules.light_samples() && scene.lights.count() > 0)
    add_light_samples<F>(scene, with.light_sampler, block, with.rules, vertex, with.is_reordering);
}

/// The paths that have come to vertex 0, to their ends: at each vertex a direction from the BSDF, along which
/// they go on to the next.
template <class F>
void go_on(const PathSetting& with, SampleBlock& block, int branch) {
  for (int vertex = 0; block.path.count > 0; ++vertex) {
    if (vertex > 0) visit<F>(with, block, vertex);
    const bool is_followed = with.rules.bsdf_samples(vertex) > 0;
    if (is_followed) sample_bsdf<F>(with.scene, block, with.rules, vertex);
    if (block.watcher) block.watcher->on_vertex(block, vertex, branch);
    if (!is_followed) break;
    follow_paths<F>(block, with.rules.needs_both_pdfs());
  }
}

/// Each sample is a path from the camera, or, where several BSDF samples leave its first vertex, as many.
template <class F>
void path(const PathSetting& with, SampleBlock& block) {
  make_cuts<F>(with.scene, with.light_sampler, block);
  camera_rays<F>(with.scene, block);
  add_lamps_at_outlines<F>(with.scene, block, with.rules.outline_rays());
  visit<F>(with, block, 0);
  const int branches = with.rules.bsdf_samples(0);
  if (branches <= 1) return go_on<F>(with, block, 0);
  const auto at_first = std::make_unique<PathColumns>(block.path);
  for (int branch = 0; branch < branches; ++branch) {
    block.path = *at_first;
    block.is_in_sample_order = true;
    // Its random numbers from here on are those of a sample of its own.
    for (int i = 0; i < block.path.padded_count; ++i)
      block.path.index[i] = at_first->index[i] * std::uint32_t(branches) + std::uint32_t(branch);
    go_on<F>(with, block, branch);
  }
}

}  // namespace etendue

// The path integrators: every way to estimate direct light, and as many bounces as the rules say.
#pragma once

#include "integrator/bsdf_stage.h"
#include "integrator/hit_stage.h"
#include "integrator/light_stage.h"

#include <memory>

namespace etendue {

/// Takes the paths to their next vertex, and adds the light that they meet there. `number`: of the BSDF
/// sample that took them there.
template <class F>
void arrive(const Scene& scene, SampleBlock& block, const PathRules& rules, int vertex, int number) {
  closest_hits<F>(scene, block, vertex == 0 ? Coherence::coherent : Coherence::incoherent);
  if (scene.medium) fly_through_medium<F>(scene, block, rules, vertex, number);
  add_emission<F>(scene, block, rules);
  if (scene.lights.infinite_count() > 0) add_environment<F>(scene, block, rules);
  block.shadow_count = 0;
}

/// Each sample is a path from the camera. At each of its vertices: the emission that it meets, the light that
/// comes straight from lights, and a direction from the BSDF, along which it goes on.
template <class F>
void path(const Scene& scene, SampleBlock& block, const PathRules& rules, bool is_reordering) {
  camera_rays<F>(scene, block);
  for (int vertex = 0; block.path.count > 0; ++vertex) {
    arrive<F>(scene, block, rules, vertex, 0);
    const bool is_scattering = vertex < rules.most_vertices;
    if (is_scattering && rules.has_light_samples() && scene.lights.count() > 0)
      add_light_samples<F>(scene, block, rules, vertex, is_reordering);
    const bool is_followed = is_scattering && rules.is_followed(vertex);
    if (is_followed) sample_bsdf<F>(scene, block, rules, vertex, 0);
    if (block.on_vertex) (*block.on_vertex)(block, vertex, 0);
    if (!is_followed) break;
    follow_paths<F>(block);
  }
}

/// Direct light by several BSDF samples at the one vertex of each path.
template <class F>
void direct_light_by_several(const Scene& scene, SampleBlock& block, const PathRules& rules,
                             bool is_reordering) {
  camera_rays<F>(scene, block);
  arrive<F>(scene, block, rules, 0, 0);
  if (rules.has_light_samples() && scene.lights.count() > 0)
    add_light_samples<F>(scene, block, rules, 0, is_reordering);
  const auto at_vertex = std::make_unique<PathColumns>(block.path);
  for (int number = 0; number < rules.bsdf_samples; ++number) {
    block.path = *at_vertex;
    block.is_in_sample_order = true;
    sample_bsdf<F>(scene, block, rules, 0, number);
    if (block.on_vertex) (*block.on_vertex)(block, 0, number);
    follow_paths<F>(block);
    if (block.path.count == 0) continue;
    arrive<F>(scene, block, rules, 1, number);
    if (block.on_vertex) (*block.on_vertex)(block, 1, number);
  }
}

}  // namespace etendue

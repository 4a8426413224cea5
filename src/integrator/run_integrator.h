// The integrator that the settings name, over one block.
#pragma once

#include "integrator/integrator.h"
#include "integrator/material.h"
#include "integrator/normals.h"
#include "integrator/path.h"
#include "integrator/simple.h"
#include "integrator/single_rays.h"
#include "integrator/visibility.h"

namespace etendue {

template <class F>
struct RunIntegrator {
  const Scene& scene;
  const LightSampler& light_sampler;
  SampleBlock& block;
  bool is_reordering;

  void operator()(const PathRules& rules) const {
    path<F>({scene, light_sampler, rules, is_reordering}, block);
  }
  void operator()(const ShowNormals&) const { normals<F>(scene, block); }
  void operator()(const ShowMaterial&) const { material<F>(scene, block); }
  void operator()(const VisibilityRules& rules) const { visibility<F>(scene, block, rules); }
  void operator()(const SimpleLight& light) const { simple<F>(scene, block, light); }
  void operator()(const SingleRays& rules) const { single_rays<F>(scene, block, rules); }
};

/// \param light_sampler over the scene's lights
/// \param is_reordering aim shadow packets; off only to show that it changes nothing
template <class F>
void run_integrator(const IntegratorSettings& settings, const Scene& scene, const LightSampler& light_sampler,
                    SampleBlock& block, bool is_reordering) {
  std::visit(RunIntegrator<F>{scene, light_sampler, block, is_reordering}, settings.rules);
}

}  // namespace etendue

// What a sample's radiance is made of: from which light, by which technique, after how many scatterings; and
// the layers that collect a part of it.
#pragma once

#include "integrator/path_rules.h"
#include "integrator/sample_block.h"

namespace etendue {

template <class F>
struct Contribution {
  Int<F> light;  ///< Its id.
  Technique technique;
  int depth;  ///< Vertices that scattered it: 0: the camera sees the light; 1: direct light.
};

/// Adds to a colour of the samples that the paths i, i + 1 ... belong to.
template <class F>
void add_to_samples(const SampleBlock& block, ColorColumn& sums, int i, const Mask<F>& m,
                    const Color<F>& added) {
  if (block.is_in_sample_order) {
    store_lanes(sums, i, load_lanes<F>(sums, i) + select(m, added, black<F>()));
    return;
  }
  const Int<F> sample = load_lanes<Int<F>>(&block.path.sample[i]);
  const auto add = [&](float* channel, const F& value) {
    scatter<F>(channel, sample, m, gather(channel, sample) + value);
  };
  add(sums.r.data(), added.r);
  add(sums.g.data(), added.g);
  add(sums.b.data(), added.b);
}

/// Adds radiance that comes from no light of the scene: of integrators that look at something else.
template <class F>
void add_radiance(SampleBlock& block, int i, const Mask<F>& m, const Color<F>& added) {
  add_to_samples<F>(block, block.radiance, i, m, added);
}

/// Adds what a light contributes to the radiance of the samples that the paths i, i + 1 ... belong to, and to
/// the layers that take it.
template <class F>
void add_contribution(SampleBlock& block, int i, const Mask<F>& m, const Color<F>& added,
                      const Contribution<F>& from) {
  add_to_samples<F>(block, block.radiance, i, m, added);
  for (LayerColumn& layer : block.layers) {
    const LayerRule& rule = layer.rule;
    if (rule.technique && *rule.technique != from.technique) continue;
    if (from.depth < rule.least_depth || from.depth > rule.most_depth) continue;
    const Mask<F> lanes = rule.light ? mask_and(m, equal(from.light, Int<F>(*rule.light))) : m;
    if (any(lanes)) add_to_samples<F>(block, layer.radiance, i, lanes, added);
  }
}

}  // namespace etendue

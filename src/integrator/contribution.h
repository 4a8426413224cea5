// What a sample's radiance is made of: from which light, by which technique, after how many scatterings; and
// the layers that collect a part of it.
#pragma once

#include "integrator/sample_block.h"

#include <utility>

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

/// Adds to the layers that take it; apart, so that its code does not weigh on images without layers.
template <class F>
[[gnu::noinline]] void add_to_layers(SampleBlock& block, int i, const Mask<F>& m, const Color<F>& added,
                                     const Contribution<F>& from) {
  ColorColumn* layers = block.layers.data();
  for (const LayerSet& set : block.layer_sets) {
    ColorColumn* const of_set = std::exchange(layers, layers + set.count());
    const std::int32_t path_part = set.part_of_path(from.technique, from.depth);
    if (path_part == LayerSet::none) continue;
    if (set.light_part.size() == 0) {
      add_to_samples<F>(block, of_set[path_part], i, m, added);
      continue;
    }
    const Int<F> light_part = set.light_part.at(select(m, from.light, Int<F>(0)));
    for_each_unique<F>(light_part, mask_and(m, less(Int<F>(LayerSet::none), light_part)),
                       [&](std::int32_t part, const Mask<F>& lanes) {
                         add_to_samples<F>(block, of_set[part * set.path_parts + path_part], i, lanes, added);
                       });
  }
}

/// Adds what a light contributes to the radiance of the samples that the paths i, i + 1 ... belong to, and to
/// the layers that take it.
template <class F>
void add_contribution(SampleBlock& block, int i, const Mask<F>& m, const Color<F>& added,
                      const Contribution<F>& from) {
  add_to_samples<F>(block, block.radiance, i, m, added);
  if (!block.layers.empty()) add_to_layers<F>(block, i, m, added, from);
}

}  // namespace etendue

// The place that light is to reach: what the choice of a light, and the sampling of one, may look at.
#pragma once

#include "base/lane_vec.h"
#include "bsdf/glossy_lobes.h"
#include "bsdf/lit_side.h"

namespace etendue {

class LightCuts;

/// A vertex of a path as lights see it. A path keeps that of its last vertex until its next ray has met a
/// light, so that both densities of a weight are computed from the same place.
template <class F>
struct Receiver {
  Vec3<F> position;  ///< World, m.
  Vec3<F> ng, ns;    ///< Unit; geometric and shading normal, in a medium towards the viewer.
  Int<F> lit_sides;  ///< Of `lit_side`.
  /// The cut of the light tree to choose from, see lightsampler/light_cuts.h; null: none.
  const LightCuts* cuts = nullptr;
  Int<F> cut = Int<F>(0);
  /// The lobes of the materials, from the one here towards the viewer; null: none has a lobe.
  const GlossyLobes* lobes = nullptr;
  Int<F> material = Int<F>(0);
  Vec3<F> wo = {F(0), F(0), F(0)};
};

/// Whether the cosine at the receiver says how much of what arrives is scattered: not where light is
/// scattered from both sides, or in the medium.
template <class F>
Mask<F> is_lit_from_one_side(const Receiver<F>& receiver) {
  return less(receiver.lit_sides, Int<F>(lit_side::front | lit_side::back));
}
/// The shading normal on the side from which light is scattered.
template <class F>
Vec3<F> lit_normal(const Receiver<F>& receiver) {
  return select(equal(receiver.lit_sides, Int<F>(lit_side::back)), -receiver.ns, receiver.ns);
}

}  // namespace etendue

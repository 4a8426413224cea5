// One light sample out of several candidates, chosen by what they would add.
#pragma once

#include "integrator/direct_light.h"

namespace etendue {

/// Of how many candidates each light sample of a vertex is one.
template <class F>
Int<F> candidates_of(const Scene& scene, const PathRules& rules, int vertex_number, const Vertex<F>& vertex) {
  const int few = rules.candidates(vertex_number), many = rules.glossy_candidates(vertex_number);
  if (few == many) return Int<F>(many);
  return select(vertex.leaves_direct_light_to_lights(scene), Int<F>(few), Int<F>(many));
}

/// Resampled importance sampling (Talbot, Cline and Egbert 2005, "Importance resampling for global
/// illumination", eq. 5): a candidate stays with a probability in proportion to the luminance of what it adds
/// where nothing hides it, and then stands for all of them, so that the expectation is that of each alone.
/// Weights of multiple importance sampling are in what candidates add already. One number chooses by
/// inverting the distribution of the candidates in their order, stretched back at each: so it stays
/// stratified over the samples of a pixel, as a reservoir with fresh numbers would not (Ciklabakkal et al.
/// 2022, "Single-pass stratified importance resampling").
template <class F>
class ResampledLight {
 public:
  explicit ResampledLight(const F& u_selection) : u_(u_selection) {}

  void offer(const DirectLightSample<F>& candidate) {
    const F adds = select(candidate.needs_shadow_ray, luminance(candidate.unshadowed), F(0));
    total_ = total_ + adds;
    // "not less": what is not a number is kept, so that it reaches the sum, where it is reported.
    const F share = select(total_ == F(0), F(0), adds / total_);
    const Mask<F> is_taken = mask_and(candidate.needs_shadow_ray, mask_not(u_ >= share));
    u_ = select(is_taken, u_ / share, (u_ - share) / (F(1) - share));
    u_ = min(max(u_, F(0)), F(0x1.fffffep-1f));
    adds_ = select(is_taken, adds, adds_);
    kept_ = is_first_ ? candidate : select(is_taken, candidate, kept_);
    is_first_ = false;
  }

  DirectLightSample<F> take() const {
    DirectLightSample<F> sample = kept_;
    sample.needs_shadow_ray = mask_not(total_ == F(0));
    const F stands_for = select(sample.needs_shadow_ray, total_ / adds_, F(0));
    sample.unshadowed = kept_.unshadowed * stands_for;
    sample.control = kept_.control * stands_for;
    return sample;
  }

 private:
  F u_, total_ = F(0), adds_ = F(1);
  DirectLightSample<F> kept_{};
  bool is_first_ = true;
};

}  // namespace etendue

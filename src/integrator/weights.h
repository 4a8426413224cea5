// The weights of light that two techniques can find. The only place with weights.
#pragma once

#include "integrator/path_rules.h"

#include <limits>

namespace etendue {

/// The weight of a direction that one technique found with density `pdf_own`, times its number of samples,
/// and that the other would find with `pdf_other`, times its own (both 1/sr; the light's density includes the
/// probability of choosing it). A density of infinity is a Dirac delta, which the other technique cannot
/// find.
template <class F>
F mis_weight(Heuristic heuristic, const F& pdf_own, const F& pdf_other) {
  switch (heuristic) {
    case Heuristic::average:
      return select(pdf_own < F(std::numeric_limits<float>::infinity()), F(0.5f), F(1));
    case Heuristic::balance:
      return F(1) / (F(1) + pdf_other / pdf_own);
    case Heuristic::maximum: {
      // About equal densities share: each side rounds its own way, and both or none might count.
      constexpr float shared = 1e-4f;
      const F lead = F(2) / (F(1) + pdf_other / pdf_own) - F(1);
      return min(max(F(0.5f) + lead * F(0.5f / shared), F(0)), F(1));
    }
    case Heuristic::power:
      break;
  }
  const F ratio = pdf_other / pdf_own;
  return F(1) / (F(1) + ratio * ratio);
}

/// Of a light sample. \param pdf_light times the number of light samples
/// \param pdf_bsdf() gives the BSDF's density of its direction, times the number of BSDF samples
template <class F, class Function>
F light_sample_weight(const PathRules& rules, const F& pdf_light, Function&& pdf_bsdf) {
  const Heuristic* heuristic = rules.heuristic();
  if (!heuristic) return F(1);
  return mis_weight(*heuristic, pdf_light, rules.needs_both_pdfs() ? pdf_bsdf() : F(0));
}

/// Of light that a ray has met. \param pdf_bsdf of the ray's direction, times the number of BSDF samples;
/// infinite: the camera's, or a Dirac delta's; 0: light samples alone find what it meets
/// \param pdf_light() gives the density of light samples of that direction, times their number; only the
/// lanes of `m` with a finite `pdf_bsdf` need it
template <class F, class Function>
F met_light_weight(const PathRules& rules, const F& pdf_bsdf, const Mask<F>& m, Function&& pdf_light) {
  const F infinity(std::numeric_limits<float>::infinity());
  const Heuristic* heuristic = rules.heuristic();
  if (!heuristic) return rules.light_samples() ? select(pdf_bsdf < infinity, F(0), F(1)) : F(1);
  if (!rules.needs_both_pdfs()) return mis_weight(*heuristic, pdf_bsdf, F(0));
  if (!any(mask_and(m, pdf_bsdf < infinity))) return F(1);
  if (rules.is_shared_only_where_glossy() && !any(mask_and(m, pdf_bsdf > F(0)))) return F(0);
  const F weight = mis_weight(*heuristic, select(mask_and(m, pdf_bsdf > F(0)), pdf_bsdf, F(1)), pdf_light());
  return select(pdf_bsdf > F(0), weight, F(0));
}

}  // namespace etendue

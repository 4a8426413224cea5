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
    case Heuristic::compensated:
    case Heuristic::optimal:
      break;
  }
  const F ratio = pdf_other / pdf_own;
  return F(1) / (F(1) + ratio * ratio);
}

/// The density of light samples that weights go by. Compensated, it is 0 where BSDF samples are a hundred
/// times as dense: the light that is left to them there needs no shadow ray.
template <class F>
F weighted_light_pdf(Heuristic heuristic, const F& pdf_light, const F& pdf_bsdf) {
  constexpr float compensation = 0.01f;
  if (heuristic != Heuristic::compensated) return pdf_light;
  return max(pdf_light - pdf_bsdf * F(compensation), F(0));
}

/// Of a light sample. \param pdf_light times the number of light samples
/// \param pdf_bsdf() gives the BSDF's density of its direction, times the number of BSDF samples
template <class F, class Function>
F light_sample_weight(const PathRules& rules, const F& pdf_light, Function&& pdf_bsdf) {
  const Heuristic* heuristic = rules.heuristic();
  if (!heuristic) return F(1);
  if (!rules.needs_both_pdfs()) return mis_weight(*heuristic, pdf_light, F(0));
  const F other = pdf_bsdf();
  return mis_weight(*heuristic, weighted_light_pdf(*heuristic, pdf_light, other), other);
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
  const F own = select(mask_and(m, pdf_bsdf > F(0)), pdf_bsdf, F(1));
  const F weight = mis_weight(*heuristic, own, weighted_light_pdf(*heuristic, pdf_light(), own));
  return select(pdf_bsdf > F(0), weight, F(0));
}

// The control variate of optimal weights: of light that both techniques can find, with coefficients a per
// sample, each adds what the other would take by the balance heuristic. Its mean over the samples of both is
// 0, whatever else the light is multiplied with, so only the difference of the coefficients counts, alpha;
// the sums of the coefficients themselves, which the paper adds, then cancel (docs/light_sampling.md).

/// What a light sample that nothing hides adds, in units of alpha; densities as of light_sample_weight.
template <class F>
F light_sample_control(const F& pdf_light, const F& pdf_bsdf) {
  return mis_weight(Heuristic::balance, pdf_bsdf, pdf_light);
}

/// What a BSDF sample adds that meets a light; densities as of met_light_weight. 0 where one of them alone
/// finds the light.
template <class F>
F met_light_control(const F& pdf_bsdf, const F& pdf_light) {
  const Mask<F> is_shared = mask_and(pdf_bsdf > F(0), pdf_bsdf < F(std::numeric_limits<float>::infinity()));
  return select(is_shared, -mis_weight(Heuristic::balance, pdf_light, select(is_shared, pdf_bsdf, F(1))),
                F(0));
}

/// As radiance. \param control by one of the two above
template <class F>
Color<F> control_variate(const Colorf& alpha, const F& control) {
  return {control * F(alpha.r), control * F(alpha.g), control * F(alpha.b)};
}

}  // namespace etendue

// What tells one path integrator from another: how direct light is estimated, and how far paths go.
#pragma once

#include "base/simd_math.h"

#include <limits>

namespace etendue {

/// How the light that reaches a vertex straight from a light is estimated.
///   lights: by a sample of the lights. bsdf: by whether the path's next ray meets a light. half: both, each
///   counted half (the plain average). balance, power: both, by multiple importance sampling (Veach 1997,
///   "Robust Monte Carlo methods for light transport simulation", eq. 9.8, and section 9.2.2.2 with exponent
///   2).
enum class DirectLight { lights, bsdf, half, balance, power };

struct PathRules {
  static constexpr int unlimited = std::numeric_limits<int>::max();

  DirectLight direct_light = DirectLight::lights;
  int most_vertices = 1;        ///< Vertices that scatter light; 1: direct light only.
  bool is_dirac_only = false;   ///< Paths go on only from mirrors and smooth dielectrics.
  bool is_every_light = false;  ///< A sample of each light, instead of one light chosen at random.
  int light_samples = 1, bsdf_samples = 1;  ///< At each vertex; more than 1 only where most_vertices is 1.

  bool has_light_samples() const { return direct_light != DirectLight::bsdf && light_samples > 0; }
  /// Whether paths go on from their vertex number `vertex`, if only to see which light they meet.
  bool is_followed(int vertex) const {
    const bool is_last = vertex + 1 >= most_vertices;
    return bsdf_samples > 0 && !(is_last && direct_light == DirectLight::lights);
  }
};

/// The weight of a direction that one technique found with density `pdf_own`, times its number of samples,
/// and that the other would find with `pdf_other`, times its own (both 1/sr; the light's density includes the
/// probability of choosing it). A density of infinity is a Dirac delta, which the other technique cannot
/// find. The only place with weights.
template <class F>
F mis_weight(DirectLight direct_light, const F& pdf_own, const F& pdf_other) {
  switch (direct_light) {
    case DirectLight::lights:
    case DirectLight::bsdf:
      return F(1);
    case DirectLight::half:
      return select(pdf_own < F(std::numeric_limits<float>::infinity()), F(0.5f), F(1));
    case DirectLight::balance:
      return F(1) / (F(1) + pdf_other / pdf_own);
    case DirectLight::power:
      break;
  }
  const F ratio = pdf_other / pdf_own;
  return F(1) / (F(1) + ratio * ratio);
}

/// Whether the weight depends on the densities of both techniques.
inline bool needs_both_pdfs(DirectLight direct_light) {
  return direct_light == DirectLight::balance || direct_light == DirectLight::power;
}

}  // namespace etendue

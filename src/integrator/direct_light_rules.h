// How the light that reaches a vertex straight from a light is estimated: samples of the lights, of the BSDF,
// or both with weights.
#pragma once

#include "base/color.h"
#include "light/technique.h"

#include <string_view>
#include <variant>

namespace etendue {

/// How two techniques share the light that both can find. average: each counted half. balance, power: by
/// multiple importance sampling (Veach 1997, "Robust Monte Carlo methods for light transport simulation",
/// eq. 9.8, and section 9.2.2.2 with exponent 2). maximum: by the technique of the higher density alone (same
/// section). compensated: by power, with a light's density that is 0 where BSDF samples suffice (Karlík et
/// al. 2019, "MIS compensation: optimizing sampling techniques in multiple importance sampling"). optimal: by
/// power, with a control variate of both densities (Kondapaneni et al. 2019, "Optimal multiple importance
/// sampling").
enum class Heuristic { average, balance, power, maximum, compensated, optimal };

struct LightSamples {
  int count = 1;                         ///< At each vertex.
  std::string_view sampler = "uniform";  ///< Which light: a name of light_sampler_plugins().
  int later_count = 0;                   ///< At the vertices behind the first; 0: as many as there.
  /// Each light sample of the first vertex is one of so many candidates, chosen by what they would add. 0: by
  /// what there is to choose from, see settled().
  int candidates = 1;
  int glossy_candidates = 0;  ///< The same where surfaces are not diffuse; 0: as many as elsewhere.
  LightTechnique technique = LightTechnique::area;  ///< Where on the light.

  friend bool operator==(const LightSamples&, const LightSamples&) = default;
};

struct ByLights {
  LightSamples lights{};

  friend bool operator==(const ByLights&, const ByLights&) = default;
};
/// By whether the path's next ray meets a light.
struct ByBsdf {
  int bsdf_samples = 1;  ///< At the first vertex, each a path of its own; one at those behind.

  friend bool operator==(const ByBsdf&, const ByBsdf&) = default;
};
struct ByBoth {
  Heuristic heuristic = Heuristic::balance;
  LightSamples lights{};
  int bsdf_samples = 1;  ///< As of ByBsdf.
  /// Where surfaces are diffuse, BSDF samples do not share in direct light, which light samples find alone.
  bool only_where_glossy = false;
  /// Of `optimal`, at the first vertex: by how much the light samples' coefficient, over their number,
  /// exceeds that of the BSDF samples, W/(m^2 sr). Any value is unbiased that was fixed before the samples.
  Colorf alpha{0, 0, 0};

  friend bool operator==(const ByBoth&, const ByBoth&) = default;
};
using DirectLight = std::variant<ByLights, ByBsdf, ByBoth>;

}  // namespace etendue

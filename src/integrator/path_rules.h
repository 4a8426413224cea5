// What tells one path integrator from another: how direct light is estimated, and how far paths go.
#pragma once

#include "base/simd_math.h"
#include "light/technique.h"

#include <algorithm>
#include <string_view>
#include <variant>

namespace etendue {

/// How two techniques share the light that both can find. average: each counted half. balance, power: by
/// multiple importance sampling (Veach 1997, "Robust Monte Carlo methods for light transport simulation",
/// eq. 9.8, and section 9.2.2.2 with exponent 2). maximum: by the technique of the higher density alone (same
/// section).
enum class Heuristic { average, balance, power, maximum };

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

// How the light that reaches a vertex straight from a light is estimated.

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

  friend bool operator==(const ByBoth&, const ByBoth&) = default;
};
using DirectLight = std::variant<ByLights, ByBsdf, ByBoth>;

/// How far paths go: only to the first vertex, whose direct light is all; on from there without end; or on
/// from mirrors and smooth dielectrics only, whose light no sample of the lights finds.
enum class PathLength { one_vertex, unlimited, through_diracs };

class PathRules {
 public:
  static PathRules direct(const DirectLight& direct_light) { return {direct_light, PathLength::one_vertex}; }
  static PathRules paths(const DirectLight& direct_light) { return {direct_light, PathLength::unlimited}; }
  /// Whitted's: no directions but the Dirac ones are sampled, so light samples must do.
  static PathRules whitted(const ByLights& direct_light) {
    return {direct_light, PathLength::through_diracs};
  }

  const DirectLight& direct_light() const { return direct_light_; }
  PathLength length() const { return length_; }
  /// Null where lights are not sampled.
  const LightSamples* light_samples() const {
    if (const auto* by = std::get_if<ByLights>(&direct_light_)) return &by->lights;
    if (const auto* by = std::get_if<ByBoth>(&direct_light_)) return &by->lights;
    return nullptr;
  }
  /// The same rules with other samples of the lights; light_samples() must not be null.
  PathRules with_light_samples(const LightSamples& lights) const {
    PathRules changed = *this;
    if (auto* by = std::get_if<ByLights>(&changed.direct_light_)) by->lights = lights;
    if (auto* by = std::get_if<ByBoth>(&changed.direct_light_)) by->lights = lights;
    return changed;
  }
  /// The same rules with another heuristic; heuristic() must not be null.
  PathRules with_heuristic(Heuristic heuristic) const {
    PathRules changed = *this;
    std::get<ByBoth>(changed.direct_light_).heuristic = heuristic;
    return changed;
  }

  /// Whether light is scattered at the vertex of this number; else only its emission counts.
  bool is_scattering(int vertex) const { return vertex == 0 || length_ != PathLength::one_vertex; }
  bool is_dirac_only() const { return length_ == PathLength::through_diracs; }

  /// Directions from the BSDF that leave a vertex, if only to see which light they meet.
  int bsdf_samples(int vertex) const {
    if (!is_scattering(vertex)) return 0;
    if (const auto* by = std::get_if<ByBsdf>(&direct_light_)) return vertex == 0 ? by->bsdf_samples : 1;
    if (const auto* by = std::get_if<ByBoth>(&direct_light_)) return vertex == 0 ? by->bsdf_samples : 1;
    return length_ == PathLength::one_vertex ? 0 : 1;
  }

  /// Light samples that a vertex takes.
  int light_count(int vertex) const {
    const LightSamples& lights = *light_samples();
    return vertex == 0 || lights.later_count == 0 ? lights.count : lights.later_count;
  }
  /// Of which each of them is one: on diffuse surfaces, and elsewhere.
  int candidates(int vertex) const { return vertex == 0 ? light_samples()->candidates : 1; }
  int glossy_candidates(int vertex) const {
    const LightSamples& lights = *light_samples();
    return vertex == 0 && lights.glossy_candidates > 0 ? lights.glossy_candidates : candidates(vertex);
  }
  /// What is drawn of the lights' densities where BSDF samples share in the light: each candidate.
  int light_draws(int vertex) const { return light_count(vertex) * glossy_candidates(vertex); }
  /// Whether BSDF samples of diffuse surfaces leave direct light to light samples.
  bool is_shared_only_where_glossy() const {
    const auto* by = std::get_if<ByBoth>(&direct_light_);
    return by && by->only_where_glossy;
  }

  /// The most that a sample takes of light samples, or of BSDF samples, at one vertex.
  int most_samples() const {
    return std::max(
        {1, bsdf_samples(0),
         light_samples() ? std::max({light_draws(0), light_draws(1), light_count(0) * candidates(0)}) : 0});
  }

  /// The heuristic where light is found by both techniques; else null.
  const Heuristic* heuristic() const {
    const auto* by = std::get_if<ByBoth>(&direct_light_);
    return by ? &by->heuristic : nullptr;
  }
  /// Whether weights depend on the densities of both techniques.
  bool needs_both_pdfs() const { return heuristic() && *heuristic() != Heuristic::average; }

  friend bool operator==(const PathRules&, const PathRules&) = default;

 private:
  PathRules(const DirectLight& direct_light, PathLength length)
      : direct_light_(direct_light), length_(length) {}
  DirectLight direct_light_;
  PathLength length_;
};

}  // namespace etendue

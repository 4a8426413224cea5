// What tells one path integrator from another: how direct light is estimated, and how far paths go.
#pragma once

#include "base/simd_math.h"
#include "integrator/direct_light_rules.h"

#include <algorithm>
#include <cstdint>
#include <variant>

namespace etendue {

/// How far paths go: only to the first vertex, whose direct light is all; on from there without end; or on
/// from mirrors and smooth dielectrics only, whose light no sample of the lights finds.
enum class PathLength { one_vertex, unlimited, through_diracs };

class PathRules {
 public:
  static PathRules direct(const DirectLight& direct_light) { return {direct_light, PathLength::one_vertex}; }
  /// \param survival_factor roulette lets paths go on so many times as often as their throughput says
  static PathRules paths(const DirectLight& direct_light, float survival_factor = 1) {
    PathRules rules{direct_light, PathLength::unlimited};
    rules.survival_factor_ = survival_factor;
    return rules;
  }
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
  /// Whether directions from the BSDF are sampled for the light that they meet.
  bool has_bsdf_samples() const { return !std::holds_alternative<ByLights>(direct_light_); }
  /// The same rules with so many of them at the first vertex; has_bsdf_samples() must hold.
  PathRules with_bsdf_samples(int count) const {
    PathRules changed = *this;
    if (auto* by = std::get_if<ByBsdf>(&changed.direct_light_)) by->bsdf_samples = count;
    if (auto* by = std::get_if<ByBoth>(&changed.direct_light_)) by->bsdf_samples = count;
    return changed;
  }
  /// The same rules with another heuristic; heuristic() must not be null.
  PathRules with_heuristic(Heuristic heuristic) const {
    PathRules changed = *this;
    std::get<ByBoth>(changed.direct_light_).heuristic = heuristic;
    return changed;
  }
  /// The same rules with another ByBoth::alpha; heuristic() must not be null.
  PathRules with_alpha(const Colorf& alpha) const {
    PathRules changed = *this;
    std::get<ByBoth>(changed.direct_light_).alpha = alpha;
    return changed;
  }

  /// Camera rays of their own by which a sample finds the lamps that the camera sees, where the image of one
  /// may end in the pixel; 0: its camera ray does everywhere.
  int outline_rays() const { return outline_rays_; }
  PathRules with_outline_rays(int count) const {
    PathRules changed = *this;
    changed.outline_rays_ = count;
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

  /// What the throughput behind the first vertex is multiplied with before roulette looks at it: of several
  /// paths from there each is worth as much as if it were alone.
  float roulette_factor() const { return survival_factor_ * float(bsdf_samples(0)); }
  float survival_factor() const { return survival_factor_; }

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

  /// The most that a sample takes of light samples, or of BSDF samples, at one vertex of all its paths, or of
  /// camera rays.
  std::int64_t most_samples() const {
    const std::int64_t paths = std::max(1, bsdf_samples(0)),
                       rays = std::max<std::int64_t>(paths, outline_rays_);
    if (!light_samples()) return rays;
    return std::max({rays, std::int64_t(light_draws(0)), std::int64_t(light_count(0)) * candidates(0),
                     is_scattering(1) ? paths * light_draws(1) : 0});
  }

  /// The heuristic where light is found by both techniques; else null.
  const Heuristic* heuristic() const {
    const auto* by = std::get_if<ByBoth>(&direct_light_);
    return by ? &by->heuristic : nullptr;
  }
  /// The coefficient of the control variate of a vertex; null where there is none.
  const Colorf* alpha(int vertex) const {
    const auto* by = std::get_if<ByBoth>(&direct_light_);
    return by && vertex == 0 && by->alpha != Colorf{0, 0, 0} ? &by->alpha : nullptr;
  }
  /// Whether weights depend on the densities of both techniques.
  bool needs_both_pdfs() const { return heuristic() && *heuristic() != Heuristic::average; }

  friend bool operator==(const PathRules&, const PathRules&) = default;

 private:
  PathRules(const DirectLight& direct_light, PathLength length)
      : direct_light_(direct_light), length_(length) {}
  DirectLight direct_light_;
  PathLength length_;
  float survival_factor_ = 1;
  int outline_rays_ = 0;
};

}  // namespace etendue

// The estimators of a scene's light that ought to agree: every technique that applies.
#pragma once

#include "integrator/integrator.h"
#include "scene/scene.h"

#include <span>
#include <string>
#include <vector>

namespace etendue {

/// One way to render the scene.
struct Estimator {
  std::string name;  ///< As options of `etendue render --integrator`: "light --technique solid_angle".
  IntegratorSettings integrator;
};

/// One that does not apply, and why.
struct LeftOutEstimator {
  std::string name, reason;
};

struct Estimators {
  std::vector<Estimator> all;
  std::vector<LeftOutEstimator> left_out;
};

/// What an image shows: direct light, light of all bounces, or light through mirrors and smooth glass. Empty
/// of integrators that show something else, such as normals.
std::string_view quantity_of(const IntegratorSettings& integrator);

/// All that estimate what `own`, the scene's integrator, does: light samples by each technique of the shapes
/// and each light sampler, BSDF samples, both by each heuristic, several candidates. Techniques and samplers
/// are combined so that each stands in at least one estimator, not each with each. `own` is among them.
/// Throws InputError where it estimates no light.
Estimators estimators_of(const Scene& scene, const IntegratorSettings& own);

/// Those of these names, each an integrator's name, with its options behind it or without. Throws InputError
/// for fewer than two, for two of different quantities, and for one that cannot see a light of the scene.
Estimators estimators_named(const Scene& scene, std::span<const std::string> names, std::size_t least = 2);

}  // namespace etendue

// How many light samples, candidates of each, and paths a camera ray is worth, told by a pilot.
//
// Where a lamp is seen whole and its parts bring alike, one light sample of one candidate has all there is to
// gain, and more only cost time; where parts of it are hidden, or thousands of lights differ, many of both
// pay. Where all noise is of bounces, several paths share a camera ray. Only trying tells.
#pragma once

#include "render/render.h"

#include <optional>
#include <vector>

namespace etendue {

/// One way that was tried.
struct TriedBudget {
  LightBudget budget;
  /// Of each pixel: of two renders, in luminance.
  std::vector<double> differences{};
  double seconds = 0;  ///< Of one sample, by a model of what it counts, so that no clock decides.

  double error() const;  ///< Mean of the differences.
  /// How many times as efficient as another way, 1 / (variance x seconds): by the square of the mean
  /// difference, or by the mean of their squares, whichever says less. 2 % of the pixels, where either way
  /// has the largest differences, count as the least of them: one rare bright sample decides nothing.
  double gain_over(const TriedBudget& other) const;
};

struct BudgetPilot {
  LightBudget chosen;
  std::vector<TriedBudget> tried;  ///< The usual one first.
  double seconds = 0;              ///< That the pilot took.

  double gain() const;  ///< Of what was chosen, over the usual one.
};

/// Renders 1 pixel in 256, 8192 at the most, twice with the usual budget of settled(), 8 samples a pixel, and
/// with others, each of which changes one number of the best so far: 16 candidates at surfaces that are not
/// diffuse; 4 light samples or 1; 1 candidate elsewhere; for paths that go on, 2, 4 and 8 from the first
/// vertex. A change is kept that gains 15 %, more paths from 5 % on. None where there is no choice: where the
/// integrator does not leave its budget to the scene, or the image has fewer than 65,536 pixels. It depends
/// on the scene and the integrator alone, not on the number of samples, threads or the seed.
std::optional<BudgetPilot> light_budget_for(const Scene& scene, const RenderSettings& settings,
                                            const StopRequest* stop = nullptr);

}  // namespace etendue

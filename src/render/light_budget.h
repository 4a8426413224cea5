// How many light samples a camera ray is worth, and how many candidates each of them, told by a pilot.
//
// Where a lamp is seen whole and its parts bring alike, one light sample of one candidate has all there is to
// gain, and more only cost time; where parts of it are hidden, or thousands of lights differ, many of both
// pay. Only trying tells.
#pragma once

#include "render/render.h"

#include <optional>
#include <vector>

namespace etendue {

/// One way that was tried.
struct TriedBudget {
  LightBudget budget;
  double error;    ///< Mean over pixels of the difference of two renders, in luminance.
  double seconds;  ///< Of one sample, by a model that knows the scene's size alone, so that no clock decides.
  double efficiency() const { return 1 / (error * error * seconds); }
};

struct BudgetPilot {
  LightBudget chosen;
  std::vector<TriedBudget> tried;  ///< The usual one first.
  double seconds = 0;              ///< That the pilot took.
};

/// Renders 1 pixel in 256 twice with each budget, 16 samples a pixel, and chooses the one with the least
/// error for its time; the usual one of settled() unless another is better by half. None where there is no
/// choice: where the integrator does not leave its budget to the scene, or the image has fewer than 65,536
/// pixels. It depends on the scene and the integrator alone, not on the number of samples, threads or the
/// seed.
std::optional<BudgetPilot> light_budget_for(const Scene& scene, const RenderSettings& settings,
                                            const StopRequest* stop = nullptr);

}  // namespace etendue

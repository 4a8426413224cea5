// The pilots that settle what a render takes: how many samples, which light samples, and where.
#pragma once

#include "render/light_budget.h"
#include "render/optimal_weights.h"
#include "render/pilot.h"
#include "render_options.h"

#include <optional>

namespace etendue::app {

/// What --error and --of ask for; nothing without --error.
std::optional<ErrorGoal> error_goal(const RenderOptions& options);

/// Those that were rendered.
struct Pilots {
  std::optional<BudgetPilot> budget;          ///< Of light samples, their candidates and BSDF samples.
  std::optional<WeightPilot> weights;         ///< Of --weights optimal.
  std::optional<Pilot> samples;               ///< Of --error and --time.
  std::optional<AllocationPilot> allocation;  ///< Of --adaptive.
  bool is_interrupted = false;                ///< Then they tell nothing.
};

/// Renders what is needed of them, puts what they tell into `settings`, and says so.
/// \param settings with the integrator as it was asked for, not settled
Pilots settle_by_pilots(const RenderOptions& options, const Scene& scene, RenderSettings& settings);

}  // namespace etendue::app

// How many samples a render takes where its time or its error is asked for.
#pragma once

#include "render/pilot.h"
#include "render_options.h"

#include <optional>

namespace etendue::app {

/// What --error and --of ask for; nothing without --error.
std::optional<ErrorGoal> error_goal(const RenderOptions& options);

/// Renders pilots where --error or --time ask for it, puts the samples a pixel that they tell into
/// `settings`, and says so. Nothing where a number of samples was asked for.
std::optional<Pilot> settle_samples(const RenderOptions& options, const Scene& scene,
                                    RenderSettings& settings);

}  // namespace etendue::app

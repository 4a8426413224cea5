// What a render says of its own error.
#pragma once

#include "render_report.h"

#include <nlohmann/json.hpp>

namespace etendue::app {

/// Adds `error`, `regions` and `checks` to the JSON of --stats.
void add_error_stats(const Rendering& rendering, nlohmann::ordered_json& json);

/// On stderr, unless --quiet: the mean with its interval, which pixels' intervals hold, and what the checks
/// say, of the image and of each region.
void report_errors(const Rendering& rendering);

}  // namespace etendue::app

// Which lights and techniques the noise of an image comes from.
#pragma once

#include "render_report.h"

namespace etendue::app {

/// `variance_share`: a list of light, technique, share and tail_slope, the largest share first; nothing
/// without
/// --noise.
void add_noise_stats(const Rendering& rendering, nlohmann::ordered_json& json);

/// On stderr: the largest shares, and which parts have an infinite variance.
void report_noise(const Rendering& rendering);

}  // namespace etendue::app

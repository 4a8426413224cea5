// One sample again, in words.
#pragma once

#include "render/replay.h"

#include <string>

namespace etendue::app {

/// From "X,Y,REPLICATE,SAMPLE"; throws InputError.
SampleId sample_id_from_text(const std::string& text);

/// What the sample computed, stage by stage, a line each.
std::string describe(const Scene& scene, const SampleId& sample, const SampleTrace& trace);

}  // namespace etendue::app

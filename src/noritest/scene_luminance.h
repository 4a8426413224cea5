// The mean luminance of a scene's image, estimated from single samples.
#pragma once

#include "integrator/integrator.h"
#include "noritest/noritest.h"
#include "scene/scene.h"
#include "stats/running.h"

#include <cstdint>

namespace etendue {

struct SceneLuminance {
  RunningStatistics samples;
  std::int64_t invalid_samples = 0;  ///< Not finite or negative; each counts as 0 in `samples`.
};

/// Renders `count` samples whose places are uniform over the whole film, through the
/// kernel and with the sampler that `test` says. The scene's camera, filter and sampler are replaced. A
/// function of the seed alone, not of the number of threads.
SceneLuminance sample_luminance(Scene& scene, const IntegratorSettings& integrator, std::int64_t count,
                                const TestSettings& test, std::uint64_t seed);

}  // namespace etendue

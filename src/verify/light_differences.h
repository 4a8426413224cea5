// Which lights two estimators differ by: both again, with a layer for each light.
#pragma once

#include "render/render.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// What one light adds to the whole image, by two estimators.
struct LightDifference {
  std::int32_t light;
  double ratio;    ///< Of a to b.
  double p_value;  ///< That both are the same; of all lights looked at together.
};

/// Of at most the eight lights with most power, those that differ at `level`, the surest first; none where
/// the render was interrupted. \param a, b all but the layers
std::vector<LightDifference> light_differences(const Scene& scene, RenderSettings a, RenderSettings b,
                                               double level, const StopRequest* stop = nullptr);

}  // namespace etendue

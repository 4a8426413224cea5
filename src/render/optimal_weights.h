// The coefficient of optimal weights, told by a pilot.
//
// With a coefficient that was fixed before the samples were taken the control variate keeps every mean; a
// coefficient from the samples that it corrects would not. So a pilot takes samples of its own.
#pragma once

#include "render/render.h"

#include <optional>

namespace etendue {

struct WeightPilot {
  Colorf alpha;           ///< ByBoth::alpha, W/(m^2 sr).
  double variance_ratio;  ///< Of luminance with coefficients of halves of the pilot over that without; 1
                          ///< where alpha is 0.
  double seconds = 0;     ///< That the pilot took.
};

/// Whether the weights are `optimal` and there can be a pilot: not in a medium, nor in images of fewer than
/// 65,536 pixels; there `optimal` is `power`.
bool needs_weight_pilot(const Scene& scene, const RenderSettings& settings);

/// Renders 1 pixel in 512 (8192 at the most) twice, 4 replicates of 8 samples each, without and with the
/// control variate, and takes for each channel the coefficient that leaves the least variance, summed over
/// the pixels: minus the covariance of image and control variate over the variance of the latter. It is made
/// smaller by four times its own noise (as the positive-part rule of James and Stein 1961 does by once), to 0
/// within two standard errors of 0: a coefficient that is wrong costs more than one that is missed. All
/// are set to 0 where, as each half of the pilot's squares tells of the coefficient of the other, they save
/// less variance than the control variate takes time. None where a stop came. It depends on the scene and the
/// integrator alone. \param settings for which needs_weight_pilot holds, with the integrator settled
std::optional<WeightPilot> optimal_alpha_for(const Scene& scene, const RenderSettings& settings,
                                             const StopRequest* stop = nullptr);

}  // namespace etendue

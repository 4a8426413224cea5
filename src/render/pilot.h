// How many samples an image needs, told by renders that are thrown away.
//
// Who looks at samples to decide when to stop, and keeps them, biases the image: it stops where rare light
// has not been met yet (Kirk, Arvo 1991, "Unbiased sampling techniques for image synthesis"). So pilots with
// random numbers of their own decide, and fresh samples make the image.
#pragma once

#include "film/error_goal.h"
#include "render/render.h"

#include <optional>

namespace etendue {

struct Pilot {
  int samples_per_pixel = 0;  ///< What the image needs, or the most there may be; at least 16.
  bool is_most = false;       ///< It would need more.
  bool is_dark = false;       ///< No pilot met any light: the image will be black.
  /// For an error: how much wider the image's bars will be than its errors (DistanceFromGoal).
  double bars_over_errors = 1;
  std::int64_t samples = 0;  ///< That the pilots took, of all pixels.
  double seconds = 0;
  bool is_interrupted = false;  ///< Then it tells nothing.
};

/// Where samples count most, as a pilot has told.
struct AllocationPilot {
  std::optional<SampleAllocation> allocation;  ///< None where the pilot was interrupted.
  int replicates = 0;                          ///< Of the image that the allocation is for.
  int samples_per_pixel = 0;                   ///< Of the pilot, which are thrown away.
  double seconds = 0;
};

/// What an image needs whose pixels take different numbers of samples.
struct ErrorAllocation {
  /// samples_per_pixel is what the allocation has on average, rounded.
  Pilot pilot;
  std::optional<SampleAllocation> allocation;  ///< None where the pilot was interrupted.
  int replicates = 0;                          ///< Of the image that the allocation is for.
};

/// Samples a pixel that pilots take at the least, and images after them.
inline constexpr int least_pilot_samples = 16;

/// From pilots of 16 samples a pixel and more, the last with at least an eighth of what is needed, each of
/// two renders (distance_from). From there on errors are taken to fall with a power of the samples half-way
/// between -1/2 and that of the last two pilots, which lies between -1/2 and -3/4. `settings` say all but the
/// number of samples.
/// \param most samples a pixel, at least 16; no more are asked for
Pilot samples_for_error(const Scene& scene, const RenderSettings& settings, const ErrorGoal& goal, int most,
                        const StopRequest* stop = nullptr);

/// As many samples of each pixel as it needs, so that a share of them reaches the goal: from pilots that give
/// each pixel at least an eighth of that, or 16, each of two renders (pixel_distances_from). Half-widths are
/// noisy, so all pixels take as much more as makes the share come out (film/needed_samples.h); none takes
/// more than one at the end of the share needs. Errors are taken to fall as by samples_for_error, the power
/// told by the pixels whose second pilot had more samples than the first. \param most samples a pixel on
/// average, at least 16
ErrorAllocation allocation_for_error(const Scene& scene, const RenderSettings& settings,
                                     const ErrorGoal& goal, int most, const StopRequest* stop = nullptr);

/// What can be rendered in `seconds` > 0, the pilots' own time taken off, from pilots that take a twentieth
/// of it; at least 16.
Pilot samples_for_time(const Scene& scene, const RenderSettings& settings, double seconds, int most,
                       const StopRequest* stop = nullptr);

/// Shares settings.samples_per_pixel (16 at least) among the pixels, so that the sum of their variances comes
/// out small. A pilot takes an eighth of them, 4 to 32. What is left goes to the pixels in proportion to
/// their half-widths (pixel_intervals, so pooled over alike pixels around) and a quarter of the image's mean
/// half-width, for what the pilot has not met; each takes one sample a replicate at least. A sample is taken
/// to cost the same everywhere. Replicates unless given are as many as for a power of two of samples. Throws
/// InputError where there are too few samples for the replicates.
AllocationPilot allocation_for(const Scene& scene, const RenderSettings& settings,
                               const StopRequest* stop = nullptr);

}  // namespace etendue

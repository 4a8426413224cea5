// How many samples an image needs, told by renders that are thrown away.
//
// Who looks at samples to decide when to stop, and keeps them, biases the image: it stops where rare light
// has not been met yet (Kirk, Arvo 1991, "Unbiased sampling techniques for image synthesis"). So pilots with
// random numbers of their own decide, and fresh samples make the image.
#pragma once

#include "film/pixel_intervals.h"
#include "render/render.h"

#include <span>

namespace etendue {

/// A share of the pixels is to have an interval of half-width at most `relative` times the larger of the
/// pixel and 1 % of the image's mean, by luminance. Pixels that met no light, such as the background, count
/// as within.
struct ErrorGoal {
  double relative;           ///< Positive.
  double share = 0.99;       ///< In (0, 1].
  double confidence = 0.95;  ///< Of the intervals.
};

struct Pilot {
  int samples_per_pixel = 0;  ///< What the image needs, or the most there may be; at least 16.
  bool is_most = false;       ///< It would need more.
  bool is_dark = false;       ///< No pilot met any light: the image will be black.
  std::int64_t samples = 0;   ///< That the pilots took, of all pixels.
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

/// Share of the rendered pixels that reach `goal.relative`. \param intervals of the film, of
/// `goal.confidence`
double share_within(const Film& film, std::span<const PixelInterval> intervals, const ErrorGoal& goal);

/// Samples a pixel that pilots take at the least, and images after them.
inline constexpr int least_pilot_samples = 16;

/// From pilots of 16 samples a pixel and more, the last with at least an eighth of what is needed; errors are
/// taken to fall with the root of the samples. `settings` say all but the number of samples.
/// \param most samples a pixel, at least 16; no more are asked for
Pilot samples_for_error(const Scene& scene, const RenderSettings& settings, const ErrorGoal& goal, int most,
                        const StopRequest* stop = nullptr);

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

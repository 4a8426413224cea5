// How far each pixel may be from its true value, and how well that is known.
#pragma once

#include "film/film.h"
#include "film/replicate_luminances.h"
#include "film/sample_allocation.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// By what a pixel's interval was made; the numbers stand in the image's layer `interval.trust`.
enum class IntervalRule : std::uint8_t {
  student_t = 0,   ///< Student's t over its own replicates.
  neighbours = 1,  ///< Its own spread is less than that of the alike pixels around it, so theirs holds.
  /// Only pixels farther away show what may happen here: it cannot be trusted.
  rare_events = 2,
  /// Neither it nor an alike pixel near it has met any light: 0 to what the rule of three allows.
  black = 3,
  unknown = 4,  ///< Fewer than two replicates.
};
constexpr int interval_rules = 5;

/// The true value is in mean - half_width ... mean + half_width with about the confidence asked for.
struct PixelInterval {
  Color<float> half_width{};  ///< Of each channel; NaN where unknown.
  float luminance_half_width = 0;
  float luminance_error = 0;  ///< Standard error of the luminance, NaN where unknown.
  IntervalRule rule = IntervalRule::unknown;
};

/// Intervals of all pixels, rows from the top.
///
/// Where few samples decide, a pixel that they have missed has a small spread and a wrong mean: no function
/// of its own replicates can tell (docs/error_bars.md). Its neighbours can. Two pixels are alike where their
/// mean luminances differ by at most three standard errors of the noisier one. A pixel whose own standard
/// error is below 3/4 of the pooled one of the alike among the 3 x 3 pixels around takes that (Student's t,
/// degrees of freedom of all); where the pooled one of 5 x 5 is more than twice that of 3 x 3, it takes the
/// former and is not to be trusted. Black pixels: Hanley, Lippman-Hand 1983, "If nothing goes wrong, is
/// everything all right?", with the largest value that a replicate of the image can have had (Samuelson
/// 1968).
///
/// \param luminances of the film's replicates; without them the error of the luminance is taken as that of
///   channels that go together, its upper bound
/// \param confidence in (0, 1), else std::domain_error
/// \param allocation of the film, where pixels took different numbers of samples: an error of neighbours is
///   then that which they would have with as many samples as the pixel
std::vector<PixelInterval> pixel_intervals(const Film& film, const ReplicateLuminances& luminances,
                                           double confidence, const SampleAllocation* allocation = nullptr);

}  // namespace etendue

// How far from the truth an image may be, and how far it is.
#pragma once

#include "film/film.h"
#include "film/pixel_intervals.h"

#include <span>
#include <vector>

namespace etendue {

/// Of a share of the pixels, the distance within which the true value lies with `confidence` is to be at most
/// `relative` times the larger of the pixel and 1 % of the image's mean, by luminance. Pixels that met no
/// light, such as the background, count as within.
struct ErrorGoal {
  double relative;           ///< Positive.
  double share = 0.99;       ///< In (0, 1].
  double confidence = 0.95;  ///< Of the intervals.
};

/// Share of the rendered pixels whose bars are within the goal. \param intervals of the film, of
/// `goal.confidence`
double share_within(const Film& film, std::span<const PixelInterval> intervals, const ErrorGoal& goal);

/// Two renders of one scene, alike but for their random numbers.
struct RenderedTwice {
  const Film &a, &b;
  std::span<const PixelInterval> intervals_a, intervals_b;
};

struct DistanceFromGoal {
  /// By what the errors of one of the two images must shrink to reach the goal: below 1 where they are
  /// within, 0 where nothing has an error; infinite where no light was met.
  double factor;
  /// How much wider the images' own bars are than their errors, of the pixels that decide.
  double bars_over_errors;
};

/// By errors and not by bars, which are on the safe side by as much as samples complement each other. The
/// pixels are put in order by the standard errors that both renders say; where the goal's share ends, the
/// squared difference of the two says how far off those are: twice the variance of one, on average over the
/// pixels around there (as many as four times those that may be farther off). A pixel that both have found
/// black while alike ones around it are lit has the error of these.
DistanceFromGoal distance_from(const RenderedTwice& images, const ErrorGoal& goal);

/// As distance_from, of each pixel by itself.
struct PixelDistances {
  /// As DistanceFromGoal::factor, rows from the top; of one that is not looked at 0.
  std::vector<float> factors;
  /// Half the squared difference of the two renders over the square of what is allowed: an estimate of the
  /// squared factor that knows nothing of bars.
  std::vector<float> differences_sq;
  /// Of the bars of the two renders, the squared logarithm of their ratio; below 0 where that tells nothing.
  std::vector<float> log_ratios_sq;
  double bars_over_errors = 1;  ///< On average (root of mean squares).
};

/// Standard deviation of the logarithm of a factor, as the bars of the two renders tell; 0 where they tell
/// nothing. \param log_ratios_sq PixelDistances::log_ratios_sq
double spread_of(const std::vector<float>& log_ratios_sq);

/// By half-widths, so that a pixel which has missed a rare event has the error of those which met it; one
/// that only one render has found lit has the error of that. How far off they are the squared differences of
/// the two renders say, on average over pixels whose half-widths, relative to the goal, are close to the
/// pixel's. \param is_looked_at of each pixel
PixelDistances pixel_distances_from(const RenderedTwice& images, const ErrorGoal& goal,
                                    const std::vector<bool>& is_looked_at);

}  // namespace etendue

// The mean of many pixels, and how well it is known.
#pragma once

#include "film/pixel_intervals.h"
#include "film/pixel_rectangle.h"
#include "stats/t_test.h"

#include <span>

namespace etendue {

/// A mean, its standard error and its interval; NaN where unknown.
struct KnownMean {
  double mean = 0, error = 0;
  Interval interval;
};

/// Over the pixels of a region, each channel and luminance.
struct RegionMean {
  Color<KnownMean> channels;
  KnownMean luminance;
};

/// Pixels are independent, so the squares of their errors add up; Student's t with the degrees of freedom of
/// Satterthwaite 1946. Pixels that are not rendered are left out.
/// \param region within the film
/// \param intervals of its pixels, as pixel_intervals gives them
RegionMean region_mean(const Film& film, std::span<const PixelInterval> intervals,
                       const PixelRectangle& region, double confidence);

}  // namespace etendue

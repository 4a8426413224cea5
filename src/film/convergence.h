// Checks of an image, or a part of it, that Monte Carlo codes of particle transport print for their users.
#pragma once

#include "film/film.h"
#include "film/pixel_rectangle.h"
#include "film/replicate_luminances.h"

#include <array>
#include <cstdint>

namespace etendue {

struct ConvergenceChecks {
  /// By what share the mean luminance would rise if the replicate that raised it most came out once more;
  /// NaN where the mean is 0 or there are fewer than two replicates. (One of the checks of MCNP.)
  double rise_by_largest;
  /// s of error ~ samples^s, from 1 to half of the replicates, and its 95 % interval; -1/2 where replicates
  /// are independent, below where they complement each other. NaN where there are fewer than 4 replicates.
  double slope, slope_low, slope_high;
  /// Of Student's t-test between the first and the last half of the replicates, pixel by pixel: in each tenth
  /// of [0, 1], the number of pixels whose p-value lies there (Kiedrowski, Solomon 2011). Flat where halves
  /// are independent, leaning to 1 where they complement each other, to 0 where something has changed between
  /// them.
  std::array<std::int64_t, 10> p_values{};
  std::int64_t p_values_below_1_percent = 0;

  std::int64_t pixels_tested() const;
};

/// \param region within the film
/// \param luminances kept; without them all is unknown
ConvergenceChecks convergence_checks(const Film& film, const ReplicateLuminances& luminances,
                                     const PixelRectangle& region);

}  // namespace etendue

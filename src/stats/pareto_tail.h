// How heavy the tail of a distribution is, by the largest of many values.
#pragma once

#include "stats/largest_values.h"

namespace etendue {

/// Of a density that falls as x^-slope far out: the variance is finite where the slope is above 3, the mean
/// where it is above 2. The slope is 10 where the density falls faster, or ends.
struct ParetoTail {
  static constexpr double steepest = 10;
  double slope, low, high;  ///< With its 95 % interval; NaN where there are too few values to tell.

  bool has_infinite_variance() const { return high < 3; }  ///< For certain, as far as the values reach.
};

/// A generalised Pareto distribution is fitted to the excesses of the largest values, a twentieth of all at
/// the most, over the least of them, as MCNP does with the 200 largest (Zhang, Stephens 2009, "A new and
/// efficient estimation method for the generalized Pareto distribution"; the interval by the asymptotic
/// variance of the maximum likelihood estimate, (1 + k)^2 / n).
ParetoTail pareto_tail(const LargestValues& largest);

}  // namespace etendue

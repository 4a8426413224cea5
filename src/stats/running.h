// Count, mean and squared deviations of a sample, updated one value or one other sample at a time.
#pragma once

#include <cstdint>

namespace etendue {

/// A sample of real values, reduced to what the tests and intervals need. A NaN or an infinity among the
/// values makes `mean` and `m2` NaN or infinite and stays visible there.
struct RunningStatistics {
  std::int64_t count = 0;  ///< Values seen.
  double mean = 0;         ///< 0 while count is 0.
  double m2 = 0;           ///< Sum of squared deviations from the mean.

  /// Adds one value (Welford 1962, "Note on a method for calculating corrected sums of squares and
  /// products").
  void add(double value);

  /// Unbiased variance of one value, m2 / (count - 1); NaN where count < 2: it is then unknown, not zero.
  double variance() const;

  /// Standard error of the mean, sqrt(variance / count); NaN where count < 2.
  double standard_error() const;

  friend bool operator==(const RunningStatistics&, const RunningStatistics&) = default;
};

/// The union of two disjoint samples (Chan, Golub, LeVeque 1979, "Updating formulae and a pairwise algorithm
/// for computing sample variances", eq. 2.1). An empty sample changes nothing, not even a bit. Rounding
/// depends on the order of the arguments.
RunningStatistics combine(const RunningStatistics& a, const RunningStatistics& b);

}  // namespace etendue

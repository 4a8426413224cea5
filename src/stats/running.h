// Count, mean and the sums of squared and cubed deviations of a sample, updated one value or one other sample
// at a time.
#pragma once

#include <cstdint>

namespace etendue {

/// A sample of real values, reduced to what the tests and intervals need. A NaN or an infinity among the
/// values makes `mean`, `m2` and `m3` NaN or infinite and stays visible there.
struct RunningStatistics {
  std::int64_t count = 0;  ///< Values seen.
  double mean = 0;         ///< 0 while count is 0.
  double m2 = 0;           ///< Sum of squared deviations from the mean.
  double m3 = 0;           ///< Sum of cubed deviations from the mean.

  /// Adds one value (Welford 1962, "Note on a method for calculating corrected sums of squares and
  /// products"; of m3: Pebay 2008, see combine).
  void add(double value);

  /// Unbiased variance of one value, m2 / (count - 1); NaN where count < 2: it is then unknown, not zero.
  double variance() const;

  /// Standard error of the mean, sqrt(variance / count); NaN where count < 2.
  double standard_error() const;

  /// Skewness of the values seen, (m3 / count) / (m2 / count)^1.5; NaN where count < 3 or all are equal.
  double skewness() const;

  friend bool operator==(const RunningStatistics&, const RunningStatistics&) = default;
};

/// The union of two disjoint samples (mean and m2: Chan, Golub, LeVeque 1979, "Updating formulae and a
/// pairwise algorithm for computing sample variances", eq. 2.1; m3: Pebay 2008, "Formulas for robust,
/// one-pass parallel computation of covariances and arbitrary-order statistical moments"). An empty
/// sample changes nothing, not even a bit. Rounding depends on the order of the arguments.
inline RunningStatistics combine(const RunningStatistics& a, const RunningStatistics& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const double count_a = double(a.count), count_b = double(b.count), count = double(a.count + b.count);
  const double share_a = count_a / count, share_b = count_b / count;
  const double difference = b.mean - a.mean, square = difference * difference;
  return {a.count + b.count, a.mean + difference * share_b, a.m2 + b.m2 + square * (count_a * share_b),
          a.m3 + b.m3 + square * difference * (count_a * share_b * (share_a - share_b)) +
              3 * difference * (share_a * b.m2 - share_b * a.m2)};
}

}  // namespace etendue

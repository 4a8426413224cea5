// Do counts follow a distribution? Pearson's chi-squared test, small cells pooled.
#pragma once

#include <span>

namespace etendue {

struct ChiSquaredOptions {
  /// Cells with fewer expected counts are pooled, smallest first, and more are taken in until the pool itself
  /// reaches this. At 5 (Cochran 1954) the statistic follows chi-squared well enough.
  double pooling_threshold = 5;
  /// A cell where nothing is expected may hold this many counts, which are then left out of the statistic;
  /// more reject at once. 0 is right for exact arithmetic; rounding of float directions needs about 1e-5 of
  /// all samples.
  double most_in_empty_cell = 0;
};

struct ChiSquaredTest {
  double statistic = 0;
  /// Cells (the pool counts as one) minus 1, the parameters being known; 0 where no test was possible.
  int degrees_of_freedom = 0;
  int pooled_cells = 0;  ///< How many cells went into the pool.
  /// The cell with most counts among those where none are expected; -1 where none has more than its
  /// allowance.
  int wrong_empty_cell = -1;
  /// Probability of a statistic at least this large if the counts follow the expectation. 0 where a cell in
  /// which nothing is expected holds more than allowed. NaN where no test was possible: fewer than two cells
  /// after pooling, or a count or expectation that is NaN, infinite or negative.
  double p_value = 0;
};

/// Pearson's test (Pearson 1900) of `observed` counts against `expected` ones, cell by cell, with the pooling
/// of the Nori test suite (W. Jakob). Judge it with is_rejected (stats/significance.h). If the distribution
/// may lose samples (a sub-density), pass the lost ones as one more cell: else the statistic is slightly
/// larger than chi-squared says. Throws std::invalid_argument where the spans differ in size.
ChiSquaredTest chi_squared_test(std::span<const double> observed, std::span<const double> expected,
                                const ChiSquaredOptions& options = {});

}  // namespace etendue

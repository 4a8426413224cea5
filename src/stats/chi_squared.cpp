#include "stats/chi_squared.h"

#include "stats/boost_policy.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace etendue {
namespace {

bool is_count(double value) { return std::isfinite(value) && value >= 0; }

double cell_statistic(double observed, double expected) {
  return (observed - expected) * (observed - expected) / expected;
}

}  // namespace

ChiSquaredTest chi_squared_test(std::span<const double> observed, std::span<const double> expected,
                                const ChiSquaredOptions& options) {
  if (observed.size() != expected.size())
    throw std::invalid_argument("chi_squared_test: as many observed as expected counts are needed");
  ChiSquaredTest test;
  test.p_value = std::numeric_limits<double>::quiet_NaN();
  if (!std::all_of(observed.begin(), observed.end(), is_count) ||
      !std::all_of(expected.begin(), expected.end(), is_count))
    return test;

  std::vector<int> cells(expected.size());
  std::iota(cells.begin(), cells.end(), 0);
  std::stable_sort(cells.begin(), cells.end(), [&](int a, int b) { return expected[a] < expected[b]; });

  double pool_observed = 0, pool_expected = 0, most = options.most_in_empty_cell;
  int terms = 0;
  for (const int cell : cells) {
    if (expected[cell] == 0) {
      if (observed[cell] > most) {
        most = observed[cell];
        test.wrong_empty_cell = cell;
      }
    } else if (expected[cell] < options.pooling_threshold ||
               (pool_expected > 0 && pool_expected < options.pooling_threshold)) {
      pool_observed += observed[cell];
      pool_expected += expected[cell];
      ++test.pooled_cells;
    } else {
      test.statistic += cell_statistic(observed[cell], expected[cell]);
      ++terms;
    }
  }
  if (test.pooled_cells > 0) {
    test.statistic += cell_statistic(pool_observed, pool_expected);
    ++terms;
  }

  test.degrees_of_freedom = std::max(0, terms - 1);
  if (test.wrong_empty_cell >= 0) {
    test.p_value = 0;
  } else if (test.degrees_of_freedom > 0) {
    const boost::math::chi_squared_distribution<double, BoostPolicy> distribution(test.degrees_of_freedom);
    test.p_value = std::isinf(test.statistic) ? 0 : cdf(complement(distribution, test.statistic));
  }
  return test;
}

}  // namespace etendue

// False-alarm rate of each statistical test: 1e-6. Seeds are fixed.
#include "stats/chi_squared.h"
#include "stats/significance.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace etendue {
namespace {

using Cells = std::vector<double>;

Cells draw(std::mt19937_64& engine, int samples, const Cells& weights) {
  std::discrete_distribution<int> distribution(weights.begin(), weights.end());
  Cells counts(weights.size(), 0);
  for (int i = 0; i < samples; ++i) ++counts[std::size_t(distribution(engine))];
  return counts;
}

Cells expected_counts(int samples, const Cells& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  Cells expected;
  for (const double weight : weights) expected.push_back(samples * weight / sum);
  return expected;
}

TEST(ChiSquared, MatchesPublishedValues) {
  // Mendel's peas (1866), 315 : 108 : 101 : 32 against 9 : 3 : 3 : 1; R: X-squared = 0.47002, df = 3, p =
  // 0.9254.
  const ChiSquaredTest peas = chi_squared_test(Cells{315, 108, 101, 32}, expected_counts(556, {9, 3, 3, 1}));
  EXPECT_NEAR(peas.statistic, 0.47002, 5e-6);
  EXPECT_EQ(peas.degrees_of_freedom, 3);
  EXPECT_NEAR(peas.p_value, 0.9254, 5e-5);
  EXPECT_EQ(peas.pooled_cells, 0);
  // The critical value at 5 % of one degree of freedom, 3.841459: (10 +- x)^2.
  const double x = std::sqrt(3.841459 * 5);
  EXPECT_NEAR(chi_squared_test(Cells{10 + x, 10 - x}, Cells{10, 10}).p_value, 0.05, 1e-7);
}

TEST(ChiSquared, PoolsSmallCellsFirstAndUntilThePoolIsLargeEnough) {
  // 1 + 2 < 5, so 6 joins them; 7 and 20 stand alone. In any order of cells.
  const Cells observed{25, 4, 0, 5, 2}, expected{20, 6, 1, 7, 2};
  const ChiSquaredTest test = chi_squared_test(observed, expected);
  EXPECT_EQ(test.pooled_cells, 3);
  EXPECT_EQ(test.degrees_of_freedom, 2);
  EXPECT_DOUBLE_EQ(test.statistic, 9.0 / 9 + 4.0 / 7 + 25.0 / 20);

  ChiSquaredOptions options;
  options.pooling_threshold = 3;  // 1 + 2 suffices.
  EXPECT_EQ(chi_squared_test(observed, expected, options).pooled_cells, 2);
  options.pooling_threshold = 0;
  EXPECT_EQ(chi_squared_test(observed, expected, options).degrees_of_freedom, 4);
}

TEST(ChiSquared, NothingMayFallWhereNothingIsExpected) {
  const Cells expected{50, 50, 0, 0};
  const ChiSquaredTest wrong = chi_squared_test(Cells{50, 50, 1, 2}, expected);
  EXPECT_EQ(wrong.p_value, 0);
  EXPECT_EQ(wrong.wrong_empty_cell, 3);
  ChiSquaredOptions options;
  options.most_in_empty_cell = 2;
  const ChiSquaredTest allowed = chi_squared_test(Cells{50, 50, 1, 2}, expected, options);
  EXPECT_EQ(allowed.p_value, 1);
  EXPECT_EQ(allowed.wrong_empty_cell, -1);
  EXPECT_EQ(allowed.degrees_of_freedom, 1);
}

TEST(ChiSquared, WhatCannotBeTestedIsNotPassed) {
  for (const auto& [observed, expected] :
       {std::pair(Cells{}, Cells{}), std::pair(Cells{10}, Cells{10}), std::pair(Cells{0, 0}, Cells{0, 0}),
        std::pair(Cells{1, 2}, Cells{2, 1}), std::pair(Cells{10, std::nan("")}, Cells{10, 10}),
        std::pair(Cells{10, 10}, Cells{10, -10}),
        std::pair(Cells{10, 10}, Cells{10, std::numeric_limits<double>::infinity()})}) {
    const ChiSquaredTest test = chi_squared_test(observed, expected);
    EXPECT_TRUE(std::isnan(test.p_value));
    EXPECT_EQ(test.degrees_of_freedom, 0);
    EXPECT_TRUE(is_rejected(test.p_value, 0.01));
  }
  EXPECT_THROW(chi_squared_test(Cells{1}, Cells{1, 2}), std::invalid_argument);
}

const Cells uneven{0.5, 3, 1, 40, 25, 0.2, 7, 30, 12, 9, 0, 18, 22, 5, 0.1, 11, 28, 14, 35, 16};

TEST(ChiSquared, PValuesAreUniformUnderTheNull) {  // 5,000 tests of 2,000 samples, small cells pooled.
  std::mt19937_64 engine(21);
  Cells p_values(20, 0);
  for (int i = 0; i < 5000; ++i) {
    const double p = chi_squared_test(draw(engine, 2000, uneven), expected_counts(2000, uneven)).p_value;
    ++p_values.at(std::min<std::size_t>(19, std::size_t(p * 20)));
  }
  EXPECT_FALSE(is_rejected(chi_squared_test(p_values, Cells(20, 250)).p_value, 1e-6));
}

TEST(ChiSquared, FindsAPlantedBias) {  // One cell of twenty is 4 % too likely. Misses: below 1e-6.
  std::mt19937_64 engine(22);
  constexpr int samples = 1'000'000;
  Cells biased = uneven;
  biased[3] *= 1.04;
  const Cells expected = expected_counts(samples, uneven);
  EXPECT_TRUE(is_rejected(chi_squared_test(draw(engine, samples, biased), expected).p_value, 1e-6));
  EXPECT_FALSE(is_rejected(chi_squared_test(draw(engine, samples, uneven), expected).p_value, 1e-6));
}

}  // namespace
}  // namespace etendue

// False-alarm rate of each statistical test: 1e-6 (stated at its place). Seeds are fixed.
#include "stats/chi_squared.h"
#include "stats/quantile.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "support/statistics_of.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace etendue {
namespace {

using test::statistics_of;

constexpr double infinity = std::numeric_limits<double>::infinity();

RunningStatistics normal_sample(std::mt19937_64& engine, int count, double mean, double deviation) {
  std::normal_distribution<double> distribution(mean, deviation);
  RunningStatistics statistics;
  for (int i = 0; i < count; ++i) statistics.add(distribution(engine));
  return statistics;
}

/// p-value of "these p-values are uniform": 20 equal cells.
double uniformity(const std::vector<double>& p_values) {
  std::vector<double> observed(20, 0), expected(20, double(p_values.size()) / 20);
  for (const double p : p_values) ++observed.at(std::min<std::size_t>(19, std::size_t(p * 20)));
  return chi_squared_test(observed, expected).p_value;
}

TEST(Quantiles, MatchPublishedTables) {  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.
  EXPECT_NEAR(normal_quantile(0.975), 1.959964, 5e-7);
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.706, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 10), 2.228, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.995, 5), 4.032, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.999, 30), 3.385, 5e-4);
  EXPECT_NEAR(chi_squared_quantile(0.95, 1), 3.841, 5e-4);
  EXPECT_NEAR(chi_squared_quantile(0.95, 10), 18.307, 5e-4);
  EXPECT_NEAR(chi_squared_quantile(0.99, 100), 135.807, 5e-4);
  EXPECT_EQ(normal_quantile(1), infinity);
  EXPECT_EQ(normal_quantile(0), -infinity);
  EXPECT_EQ(chi_squared_quantile(0, 3), 0);
  EXPECT_THROW(normal_quantile(1.5), std::domain_error);
  EXPECT_THROW(student_t_quantile(0.5, -1), std::domain_error);
  EXPECT_THROW(chi_squared_quantile(std::nan(""), 1), std::domain_error);
}

TEST(TTest, MatchesPublishedValues) {
  // Critical values are where p is the level: t(0.975, 10) = 2.228139, and so on.
  const RunningStatistics eleven{11, 2.228139, 110};  // Standard error 1.
  EXPECT_NEAR(t_test(eleven, 0).p_value, 0.05, 1e-7);
  EXPECT_NEAR(t_test(eleven, 2 * 2.228139).p_value, 0.05, 1e-7);
  EXPECT_NEAR(t_test(eleven, 0).statistic, 2.228139, 1e-12);
  EXPECT_EQ(t_test(eleven, 0).degrees_of_freedom, 10);
  EXPECT_EQ(t_test(eleven, 2.228139).p_value, 1);
  // Student's own data (1908), additional hours of sleep; t = 4.0621, p = 0.002833 as in R's t.test(paired).
  const RunningStatistics sleep = statistics_of({1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4});
  EXPECT_NEAR(t_test(sleep, 0).statistic, 4.0621, 5e-5);
  EXPECT_NEAR(t_test(sleep, 0).p_value, 0.002833, 5e-7);
}

TEST(TTest, VarianceFloor) {
  const RunningStatistics constant{100, 1.001, 0};
  EXPECT_EQ(t_test(constant, 1).p_value, 0);
  EXPECT_NEAR(t_test(constant, 1, 1e-4).statistic, 1, 1e-10);
  const RunningStatistics wide{100, 1.001, 99};
  EXPECT_EQ(t_test(wide, 1, 1e-4).p_value, t_test(wide, 1).p_value);
}

TEST(TTest, DegenerateSamples) {
  EXPECT_EQ(t_test({10, 0.5, 0}, 0.5).p_value, 1);
  EXPECT_EQ(t_test({10, 0.5, 0}, 0.25).p_value, 0);
  EXPECT_EQ(t_test({10, 0.5, 0}, 0.25).statistic, infinity);
  for (const RunningStatistics& bad : {RunningStatistics{}, RunningStatistics{1, 0.5, 0},
                                       statistics_of({1, std::nan("")}), statistics_of({1, 2, infinity})}) {
    EXPECT_TRUE(std::isnan(t_test(bad, 0.5).p_value));
    EXPECT_TRUE(std::isnan(t_test(bad, 0.5, 1e-5).p_value));
    EXPECT_TRUE(std::isnan(welch_t_test(bad, {10, 0.5, 1}).p_value));
    EXPECT_TRUE(std::isnan(welch_t_test({10, 0.5, 1}, bad).p_value));
  }
  EXPECT_EQ(welch_t_test({10, 0.5, 0}, {7, 0.5, 0}).p_value, 1);
  EXPECT_EQ(welch_t_test({10, 0.5, 0}, {7, 0.6, 0}).p_value, 0);
  EXPECT_LT(welch_t_test({10, 0.5, 0}, {7, 0.6, 1e-6}).p_value, 1e-4);
  EXPECT_TRUE(std::isnan(t_test({10, 0.5, 1}, std::nan("")).p_value));
}

TEST(WelchTTest, MatchesPublishedValues) {
  // The sleep data as two groups; R: t = -1.8608, df = 17.776, p-value = 0.07939.
  const RunningStatistics first = statistics_of({0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0});
  const RunningStatistics second = statistics_of({1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4});
  const MeanTest test = welch_t_test(first, second);
  EXPECT_NEAR(test.statistic, -1.8608, 5e-5);
  EXPECT_NEAR(test.degrees_of_freedom, 17.776, 5e-4);
  EXPECT_NEAR(test.p_value, 0.07939, 5e-6);
  EXPECT_EQ(welch_t_test(second, first).p_value, test.p_value);
}

TEST(ZTest, MatchesPublishedValues) {
  EXPECT_NEAR(z_test(1.959964, 0, 1).p_value, 0.05, 1e-7);
  EXPECT_NEAR(z_test(1, 1 + 2 * 2.575829, 2).p_value, 0.01, 1e-7);
  EXPECT_NEAR(z_test(10, 0, 1).p_value, 1.5239706e-23, 1e-29);  // Not 0: tails are kept.
  EXPECT_EQ(z_test(3, 3, 0).p_value, 1);
  EXPECT_EQ(z_test(3, 4, 0).p_value, 0);
  EXPECT_TRUE(std::isnan(z_test(std::nan(""), 4, 1).p_value));
  EXPECT_TRUE(std::isnan(z_test(3, 4, -1).p_value));
}

TEST(StudentInterval, MatchesTheQuantile) {
  const Interval interval = student_t_interval({11, 5, 110}, 0.95);
  EXPECT_NEAR(interval.lower, 5 - 2.228139, 1e-6);
  EXPECT_NEAR(interval.upper, 5 + 2.228139, 1e-6);
}

TEST(StudentInterval, DegenerateSamples) {
  EXPECT_EQ(student_t_interval({1, 5, 0}, 0.95).lower, -infinity);
  EXPECT_EQ(student_t_interval({}, 0.95).upper, infinity);
  EXPECT_EQ(student_t_interval({9, 5, 0}, 0.95).lower, 5);
  EXPECT_EQ(student_t_interval({9, 5, 0}, 0.95).upper, 5);
  EXPECT_TRUE(std::isnan(student_t_interval({2, std::nan(""), std::nan("")}, 0.95).lower));
  EXPECT_THROW(student_t_interval({9, 5, 1}, 1.5), std::domain_error);
  EXPECT_THROW(student_t_interval({9, 5, 1}, 0), std::domain_error);
  EXPECT_THROW(student_t_interval({9, 5, 1}, 1), std::domain_error);
}

// 20,000 tests of a true hypothesis each: their p-values must be uniform. False alarms: 1e-6 each.
TEST(TTest, PValuesAreUniformUnderTheNull) {
  std::mt19937_64 engine(11);
  std::vector<double> one_sample, two_samples, z;
  for (int i = 0; i < 20'000; ++i) {
    const RunningStatistics a = normal_sample(engine, 5, 3, 2), b = normal_sample(engine, 12, 3, 4);
    one_sample.push_back(t_test(a, 3).p_value);
    two_samples.push_back(welch_t_test(b, normal_sample(engine, 20, 3, 4)).p_value);
    z.push_back(z_test(a.mean, 3, 2 / std::sqrt(5.0)).p_value);
  }
  EXPECT_FALSE(is_rejected(uniformity(one_sample), 1e-6));
  EXPECT_FALSE(is_rejected(uniformity(two_samples), 1e-6));
  EXPECT_FALSE(is_rejected(uniformity(z), 1e-6));
  // And the check notices the commonest mistake: the normal tail in place of Student's.
  std::vector<double> wrong;
  for (int i = 0; i < 20'000; ++i) {
    const RunningStatistics a = normal_sample(engine, 5, 3, 2);
    wrong.push_back(z_test(a.mean, 3, a.standard_error()).p_value);
  }
  EXPECT_TRUE(is_rejected(uniformity(wrong), 1e-6));
}

TEST(TTest,
     FindsAPlantedBias) {  // Of 2 % of the deviation in 1e6 values: 20 standard errors. Misses: below 1e-12.
  std::mt19937_64 engine(12);
  const RunningStatistics biased = normal_sample(engine, 1'000'000, 1.02, 1);
  EXPECT_TRUE(is_rejected(t_test(biased, 1).p_value, 1e-6));
  EXPECT_FALSE(is_rejected(t_test(biased, 1.02).p_value, 1e-6));
  EXPECT_TRUE(is_rejected(welch_t_test(biased, normal_sample(engine, 1'000'000, 1, 1)).p_value, 1e-6));
}

// The interval holds the truth as often as it says: 20,000 intervals, binomial z-test. False alarms: 1e-6
// each.
TEST(StudentInterval, CoversAsOftenAsItSays) {
  std::mt19937_64 engine(13);
  for (const int count : {2, 4, 16}) {
    for (const double confidence : {0.5, 0.95, 0.99}) {
      int covered = 0;
      constexpr int trials = 20'000;
      for (int i = 0; i < trials; ++i) {
        const Interval interval = student_t_interval(normal_sample(engine, count, -7, 3), confidence);
        covered += interval.lower <= -7 && -7 <= interval.upper;
      }
      const double error = std::sqrt(confidence * (1 - confidence) / trials);
      EXPECT_FALSE(is_rejected(z_test(double(covered) / trials, confidence, error).p_value, 1e-6))
          << count << " values at " << confidence << ": " << covered;
    }
  }
}

}  // namespace
}  // namespace etendue

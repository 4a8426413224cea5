#include "stats/running.h"
#include "support/statistics_of.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace etendue {
namespace {

using test::statistics_of;

TEST(RunningStatistics, MatchesTheTextbook) {
  const RunningStatistics s = statistics_of({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(s.count, 8);
  EXPECT_DOUBLE_EQ(s.mean, 5);
  EXPECT_DOUBLE_EQ(s.m2, 32);
  EXPECT_DOUBLE_EQ(s.m3, 42);
  EXPECT_DOUBLE_EQ(s.variance(), 32.0 / 7);
  EXPECT_DOUBLE_EQ(s.standard_error(), std::sqrt(32.0 / 7 / 8));
  EXPECT_DOUBLE_EQ(s.skewness(), (42.0 / 8) / std::pow(32.0 / 8, 1.5));
}

TEST(RunningStatistics, SkewnessIsThatOfTheValues) {
  EXPECT_TRUE(std::isnan(statistics_of({1, 2}).skewness()));
  EXPECT_TRUE(std::isnan(statistics_of({2, 2, 2, 2}).skewness()));
  EXPECT_DOUBLE_EQ(statistics_of({1, 2, 3}).skewness(), 0);
  EXPECT_LT(statistics_of({-9, 2, 3, 3}).skewness(), -1);
}

TEST(RunningStatistics, ConstantValuesHaveExactlyNoVariance) {
  RunningStatistics s;
  for (int i = 0; i < 1000; ++i) s.add(0.1);
  EXPECT_EQ(s.mean, 0.1);
  EXPECT_EQ(s.m2, 0);
  EXPECT_EQ(combine(s, statistics_of({0.1, 0.1, 0.1})).mean, 0.1);
  EXPECT_EQ(combine(s, statistics_of({0.1, 0.1, 0.1})).m2, 0);
}

TEST(RunningStatistics,
     SurvivesALargeOffset) {  // Where sum of squares minus square of sum loses every digit.
  const RunningStatistics s = statistics_of({1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
  EXPECT_DOUBLE_EQ(s.mean, 1e9 + 10);
  EXPECT_DOUBLE_EQ(s.variance(), 30);
}

TEST(RunningStatistics, VarianceOfTooFewIsUnknown) {
  EXPECT_TRUE(std::isnan(RunningStatistics{}.variance()));
  EXPECT_TRUE(std::isnan(RunningStatistics{}.standard_error()));
  EXPECT_TRUE(std::isnan(statistics_of({3}).variance()));
  EXPECT_EQ(statistics_of({3}).mean, 3);
}

TEST(RunningStatistics, KeepsANaNInSight) {
  EXPECT_TRUE(std::isnan(statistics_of({1, std::nan(""), 2}).mean));
  EXPECT_TRUE(std::isnan(statistics_of({1, std::numeric_limits<double>::infinity(), 2}).m2));
}

TEST(RunningStatistics, CombiningEqualsAddingAll) {
  std::mt19937_64 engine(1);
  std::exponential_distribution<double> distribution(1e-3);
  RunningStatistics first, second, all;
  for (int i = 0; i < 3000; ++i) {
    const double value = distribution(engine);
    (i < 700 ? first : second).add(value);
    all.add(value);
  }
  const RunningStatistics both = combine(first, second);
  EXPECT_EQ(both.count, all.count);
  EXPECT_NEAR(both.mean, all.mean, 1e-13 * all.mean);
  EXPECT_NEAR(both.m2, all.m2, 1e-12 * all.m2);
  EXPECT_NEAR(both.m3, all.m3, 1e-12 * all.m3);
  EXPECT_NEAR(both.skewness(), 2, 0.5);  // of the exponential distribution
  EXPECT_EQ(combine(all, {}), all);
  EXPECT_EQ(combine({}, all), all);
}

TEST(RunningStatistics, DoesNotDrift) {
  // 4e6 values one by one, then 25 such sets combined: 1e8 values whose mean and variance are known exactly.
  RunningStatistics set;
  for (int i = 0; i < 1'000'000; ++i)
    for (const double value : {1000.1, 1000.2, 1000.3, 1000.4}) set.add(value);
  RunningStatistics all;
  for (int i = 0; i < 25; ++i) all = combine(all, set);
  EXPECT_EQ(all.count, 100'000'000);
  EXPECT_NEAR(all.mean, 1000.25, 1000.25 * 1e-12);
  EXPECT_NEAR(all.m2 / double(all.count), 0.0125, 0.0125 * 1e-9);
}

}  // namespace
}  // namespace etendue

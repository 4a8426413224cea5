#include "stats/mean_moments.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace etendue {
namespace {

TEST(MeanMoments, AreThoseOfTheMean) {
  constexpr std::array<float, 4> values{0, 0, 0, 4};
  const MeanMoments moments = moments_of_mean(values);
  EXPECT_DOUBLE_EQ(moments.mean, 1);
  EXPECT_DOUBLE_EQ(moments.variance, 1);  // m2 = 12, over 4 * 3
  EXPECT_DOUBLE_EQ(moments.third, 1);     // m3 = 24, over 4 * 3 * 2
  // Variance of one value 4; its own: m4 / 4 = 21, less 16 / 3, over 4; and that of the mean a 16th of it.
  EXPECT_DOUBLE_EQ(moments.variance_error_sq, std::max(2.0 / 3 * 16, (21 - 16.0 / 3) / 4) / 16);
}

TEST(MeanMoments, OfFewValuesAreUnknown) {
  constexpr std::array<float, 2> values{1, 2};
  EXPECT_DOUBLE_EQ(moments_of_mean(values).mean, 1.5);
  EXPECT_TRUE(std::isnan(moments_of_mean(values).variance));
  EXPECT_TRUE(std::isnan(test_same_mean(moments_of_mean(values), moments_of_mean(values)).p_value));
}

TEST(MeanMoments, OfSumsAddUpAndScale) {
  MeanMoments sum{1, 2, 3, 4};
  sum += {10, 20, 30, 40};
  const MeanMoments half = sum.scaled(0.5);
  EXPECT_DOUBLE_EQ(half.mean, 5.5);
  EXPECT_DOUBLE_EQ(half.variance, 5.5);
  EXPECT_DOUBLE_EQ(half.third, 33.0 / 8);
  EXPECT_DOUBLE_EQ(half.variance_error_sq, 44.0 / 16);
}

/// A count of events, each worth 1, as an estimate.
MeanMoments poisson(double count) { return {count, count, count, count}; }

TEST(MeanMoments, VarianceOfCountsIsThatOfTheTruth) {
  const MeanMoments exact{100, 0, 0, 0};
  EXPECT_DOUBLE_EQ(variance_if_same(poisson(50), exact, 0, 0), 100);
  // Where too many have come, the lower bound is what was found.
  EXPECT_DOUBLE_EQ(variance_if_same(poisson(150), exact, 0, 0), 150);
}

TEST(MeanMoments, ThatFoundNothingCannotTell) {
  const MeanMoments nothing{0, 0, 0, 0}, exact{3, 0, 0, 0};
  EXPECT_DOUBLE_EQ(test_same_mean(nothing, exact).p_value, 0);
  EXPECT_GT(test_same_mean(nothing, exact, 1, 0).p_value,
            0.01);  // One event is worth 1: 3 may all be missed.
}

TEST(MeanMoments, RoundingIsNoDifference) {
  EXPECT_EQ(test_same_mean({1, 0, 0, 0}, {1 + 1e-6, 0, 0, 0}).p_value, 1);
  EXPECT_EQ(test_same_mean({1, 0, 0, 0}, {1 + 1e-4, 0, 0, 0}).p_value, 0);
  EXPECT_GT(test_same_mean({1, 1e-16, 0, 1e-34}, {1 + 3e-6, 1e-16, 0, 1e-34}).p_value, 0.1);
}

TEST(MeanMoments, SmallestDifferenceIsFoundNineTimesInTen) {
  const MeanMoments a{1, 1e-4, 0, 1e-12};
  const double level = 1e-3, difference = smallest_difference(a, a, 0, 0, level);
  // 3.29 and 1.28 standard errors of the difference.
  EXPECT_NEAR(difference, (3.2905 + 1.2816) * std::sqrt(2e-4), 1e-3);
  // Of skewed estimates it is larger.
  EXPECT_GT(smallest_difference(a, a, 0.01, 0, level), 1.3 * difference);
}

}  // namespace
}  // namespace etendue

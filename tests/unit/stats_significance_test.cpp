#include "stats/significance.h"

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

namespace etendue {
namespace {

TEST(Significance, SidakLevel) {
  EXPECT_EQ(sidak_level(0.05, 1), 0.05);
  EXPECT_NEAR(sidak_level(0.05, 10), 0.005116197, 5e-10);
  EXPECT_NEAR(1 - std::pow(1 - sidak_level(0.01, 37), 37), 0.01, 1e-14);
  EXPECT_NEAR(sidak_level(1e-12, 1'000'000), 1e-18, 1e-29);  // 1 - pow(1 - 1e-12, 1e-6) would be 0.
}

TEST(Significance, RejectsBelowTheLevelOfTheFamily) {
  EXPECT_TRUE(is_rejected(0.009, 0.01));
  EXPECT_FALSE(is_rejected(0.011, 0.01));
  EXPECT_FALSE(is_rejected(0.009, 0.01, 2));
  EXPECT_TRUE(is_rejected(0, 0.01, 1'000'000));
  EXPECT_FALSE(is_rejected(1, 0.01));
}

TEST(Significance, HolmRaisesTheLeastMost) {
  const std::vector<double> p{0.03, 0.01, 0.02, std::nan(""), 0.9};
  const std::vector<double> adjusted = holm_adjusted(p);
  EXPECT_DOUBLE_EQ(adjusted[1], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[0], 0.06);
  EXPECT_TRUE(std::isnan(adjusted[3]));
  EXPECT_DOUBLE_EQ(adjusted[4], 0.9);
}

TEST(Significance, WhatCouldNotBeTestedHasNotPassed) { EXPECT_TRUE(is_rejected(std::nan(""), 0.01)); }

TEST(Significance, RefusesImpossibleLevels) {
  EXPECT_THROW(sidak_level(0, 1), std::domain_error);
  EXPECT_THROW(sidak_level(1, 1), std::domain_error);
  EXPECT_THROW(sidak_level(std::nan(""), 1), std::domain_error);
  EXPECT_THROW(is_rejected(0.5, 0.01, 0), std::domain_error);
}

}  // namespace
}  // namespace etendue

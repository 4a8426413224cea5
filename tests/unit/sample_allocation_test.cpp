// Samples are shared out by weight, none are lost, and none are taken that there are not.
#include "film/sample_allocation.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

constexpr int width = 64, height = 48;

TEST(SampleAllocation, FollowsWeightsOfAnyScaleWithinABudget) {
  std::mt19937_64 engine(3);
  std::lognormal_distribution<float> law(0, 2);
  for (const float scale : {1e-30f, 1.0f, 1e30f}) {
    std::vector<float> weights(width * height);
    for (float& weight : weights) weight = scale * law(engine);
    const SampleAllocation allocation = allocate(width, weights, 20, 1 << 20);
    ASSERT_EQ(allocation.height(), height);
    EXPECT_LE(allocation.mean(), 20);
    EXPECT_GT(allocation.mean(), 20 - double(allocation.most()) / (width * height));
    float least_ratio = INFINITY, most_ratio = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int count = allocation.at(x, y);
        ASSERT_TRUE(std::has_single_bit(unsigned(count)));
        if (count == 1) continue;  // Those that weigh less may take no fewer.
        const float ratio = float(count) / weights[std::size_t(y * width + x)];
        least_ratio = std::min(least_ratio, ratio);
        most_ratio = std::max(most_ratio, ratio);
      }
    EXPECT_LE(most_ratio, 2.01f * least_ratio);
  }
}

TEST(SampleAllocation, SpendsTheBudgetWherePixelsWeighTheSame) {
  const SampleAllocation alike = allocate(width, std::vector<float>(width * height, 0.7f), 7, 1 << 20);
  EXPECT_EQ(alike.least(), 4);
  EXPECT_EQ(alike.most(), 8);
  EXPECT_NEAR(alike.mean(), 7, 8.0 / (width * height));
  int upper_half = 0;  // Those that take more lie everywhere.
  for (int y = 0; y < height / 2; ++y)
    for (int x = 0; x < width; ++x) upper_half += alike.at(x, y);
  EXPECT_NEAR(upper_half, 7 * width * height / 2, 0.03 * 7 * width * height / 2);
}

TEST(SampleAllocation, KeepsToItsBounds) {
  std::vector<float> weights(width * height, 0);
  const SampleAllocation nothing = allocate(width, weights, 5, 64);
  EXPECT_EQ(nothing.most(), 1);
  weights[17] = 1;
  const SampleAllocation one = allocate(width, weights, 5, 64);
  EXPECT_EQ(one.at(17, 0), 64);
  EXPECT_EQ(one.mean(), 1 + 63.0 / (width * height));
  const SampleAllocation none_to_share = allocate(width, std::vector<float>(width * height, 1), 1, 64);
  EXPECT_EQ(none_to_share.most(), 1);
}

}  // namespace
}  // namespace etendue

// The tails of distributions that are known, by the largest of their values.
//
// Seeds are fixed. Intervals hold in 95 % of cases, of which 50 are counted; that fewer than 38 hold has a
// chance of 1e-5. Seen to fail when: the slope is 1/k; the threshold is not subtracted.
#include "stats/pareto_tail.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace etendue {
namespace {

template <class Function>
LargestValues largest_of(int count, std::uint32_t seed, const Function& value) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  LargestValues largest;
  for (int i = 0; i < count; ++i) largest.add(float(value(1 - u(random))));
  largest.count(count);
  return largest;
}

TEST(ParetoTail, HasTheSlopeOfTheDensity) {
  for (const double alpha : {1.5, 3.0}) {
    int holding = 0;
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
      const ParetoTail tail =
          pareto_tail(largest_of(20000, seed, [&](double u) { return std::pow(u, -1 / alpha) - 0.5; }));
      holding += tail.low <= alpha + 1 && alpha + 1 <= tail.high;
      EXPECT_LE(tail.low, tail.slope);
      EXPECT_LE(tail.slope, tail.high);
    }
    EXPECT_GE(holding, 38) << alpha;
  }
}

TEST(ParetoTail, TellsInfiniteVarianceFromFinite) {
  int infinite = 0, finite = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    infinite += pareto_tail(largest_of(30000, seed, [](double u) {
                  return std::pow(u, -0.9);
                })).has_infinite_variance();
    finite +=
        pareto_tail(largest_of(30000, seed, [](double u) { return -std::log(u); })).has_infinite_variance();
  }
  EXPECT_EQ(infinite, 20);
  EXPECT_EQ(finite, 0);
}

TEST(ParetoTail, IsSteepestWhereTheDensityEnds) {
  const ParetoTail tail = pareto_tail(largest_of(100000, 1, [](double u) { return u; }));
  EXPECT_EQ(tail.slope, ParetoTail::steepest);
  const ParetoTail of_one_value = pareto_tail(largest_of(100000, 1, [](double) { return 2; }));
  EXPECT_EQ(of_one_value.slope, ParetoTail::steepest);
}

TEST(ParetoTail, OfFewValuesIsUnknown) {
  EXPECT_TRUE(std::isnan(pareto_tail(largest_of(200, 1, [](double u) { return 1 / u; })).slope));
  EXPECT_TRUE(std::isnan(pareto_tail(LargestValues()).slope));
  EXPECT_FALSE(pareto_tail(LargestValues()).has_infinite_variance());
}

TEST(LargestValues, AreTheSameInAnyOrderAndParts) {
  LargestValues whole, first, second;
  for (int i = 0; i < 5000; ++i) whole.add(float(i % 4999));
  for (int i = 4999; i >= 0; --i) (i % 3 == 0 ? first : second).add(float(i % 4999));
  second.add(first);
  const auto sorted = [](std::vector<float> values) {
    std::sort(values.begin(), values.end());
    return values;
  };
  EXPECT_EQ(sorted(whole.values()), sorted(second.values()));
  EXPECT_EQ(sorted(whole.values()).front(), 3999);
  EXPECT_EQ(sorted(whole.values()).back(), 4998);
  EXPECT_EQ(whole.values().size(), LargestValues::most);
}

}  // namespace
}  // namespace etendue

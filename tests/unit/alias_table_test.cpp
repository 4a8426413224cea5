// The alias table: what it says it chooses against what it chooses.
#include "base/alias_table.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace etendue {
namespace {

std::vector<double> shares(const std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> result;
  for (const double w : weights) result.push_back(w / sum);
  return result;
}

const std::vector<std::vector<double>>& several_weights() {
  static const std::vector<std::vector<double>> all{{1},
                                                    {1, 1},
                                                    {1, 3},
                                                    {0, 1, 0},
                                                    {1, 0, 2, 0, 3, 0},
                                                    {5, 4, 3, 2, 1},
                                                    {1e-3, 1, 1e3, 1, 1, 1, 7},
                                                    {1e308, 1e308, 1e308},
                                                    {1e-308, 2e-308},
                                                    {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};
  return all;
}

AliasSample<float> sample(const AliasTable& table, std::uint32_t u) {
  return sample_alias<float>(table.threshold.data(), table.alias.data(), 0, std::int32_t(table.size()), u);
}

/// The share of all 2^32 values of u that choose each entry, by bisection: within a cell, the choice changes
/// once.
std::vector<float> count_all_choices(const AliasTable& table) {
  const std::uint64_t n = table.size();
  std::vector<std::uint64_t> count(n);
  for (std::uint64_t cell = 0; cell < n; ++cell) {
    const auto begin = ((cell << 32) + n - 1) / n;
    const auto end = (((cell + 1) << 32) + n - 1) / n;
    const auto choice = [&](std::uint64_t u) { return sample(table, static_cast<std::uint32_t>(u)).index; };
    auto low = begin, high = end;  // the choice is the first one below `low`, another from `high` on
    while (low < high) {
      const auto middle = (low + high) / 2;
      choice(middle) == choice(begin) ? low = middle + 1 : high = middle;
    }
    count[choice(begin)] += low - begin;
    if (low < end) count[choice(end - 1)] += end - low;
  }
  EXPECT_EQ(std::accumulate(count.begin(), count.end(), std::uint64_t{0}), std::uint64_t{1} << 32);
  std::vector<float> share;
  for (const auto c : count) share.push_back(static_cast<float>(static_cast<double>(c) * 0x1p-32));
  return share;
}

TEST(AliasTable, pmf_is_the_share_of_the_weight) {
  for (const auto& weights : several_weights()) {
    const auto table = make_alias_table(weights);
    double largest = 0;
    for (const double w : weights) largest = std::max(largest, w);
    auto scaled = weights;
    for (double& w : scaled) w /= largest;
    const auto expected = shares(scaled);
    ASSERT_EQ(table.size(), weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(table.pmf[i], expected[i], 1e-7) << i;
    EXPECT_NEAR(std::accumulate(table.pmf.begin(), table.pmf.end(), 0.0), 1, 1e-6);
  }
}

TEST(AliasTable, pmf_is_exactly_what_all_values_of_u_choose) {
  for (const auto& weights : several_weights()) {
    const auto table = make_alias_table(weights);
    EXPECT_EQ(count_all_choices(table), table.pmf);
  }
}

// False alarms: below 1e-6 for each of the ten tables; the seed is fixed.
TEST(AliasTable, frequencies_pass_chi_squared) {
  std::mt19937 random(1);
  constexpr int samples = 1'000'000;
  for (const auto& weights : several_weights()) {
    const auto table = make_alias_table(weights);
    std::vector<double> count(weights.size());
    for (int i = 0; i < samples; ++i) ++count[sample(table, static_cast<std::uint32_t>(random())).index];
    double statistic = 0;
    int cells = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double expected = table.pmf[i] * static_cast<double>(samples);
      if (expected == 0) {
        EXPECT_EQ(count[i], 0);
        continue;
      }
      statistic += (count[i] - expected) * (count[i] - expected) / expected;
      ++cells;
    }
    if (cells > 1) {
      EXPECT_LT(statistic, quantile(complement(boost::math::chi_squared(cells - 1), 1e-6)));
    }
  }
}

TEST(AliasTable, u_left_is_uniform_again) {
  const auto table = make_alias_table(std::vector<double>{1, 2, 0, 4, 0.25});
  std::vector<double> sum(table.size()), sum_sq(table.size()), count(table.size());
  for (std::uint64_t u = 0; u < std::uint64_t{1} << 32; u += 4099) {
    const auto s = sample(table, static_cast<std::uint32_t>(u));
    ASSERT_GE(s.u_left, 0);
    ASSERT_LT(s.u_left, 1);
    sum[s.index] += s.u_left;
    sum_sq[s.index] += s.u_left * s.u_left;
    ++count[s.index];
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (count[i] == 0) continue;
    EXPECT_NEAR(sum[i] / count[i], 1.0 / 2, 1e-3) << i;
    EXPECT_NEAR(sum_sq[i] / count[i], 1.0 / 3, 1e-3) << i;
  }
}

TEST(AliasTable, one_entry) {
  const auto table = make_alias_table(std::vector<double>{0.3});
  EXPECT_EQ(table.pmf[0], 1);
  for (const std::uint32_t u : {0u, 1u, 0x80000000u, 0xFFFFFFFFu}) {
    EXPECT_EQ(sample(table, u).index, 0u);
    EXPECT_LT(sample(table, u).u_left, 1);
  }
}

TEST(AliasTable, weight_zero_is_never_chosen) {
  // Also where rounding leaves entries over at the end of the construction: many weights that are no binary
  // fractions.
  std::vector<double> weights;
  for (int i = 0; i < 10007; ++i) weights.push_back(i % 3 == 0 ? 0 : 0.1 * (i % 7 + 1));
  const auto table = make_alias_table(weights);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) {
      EXPECT_EQ(table.pmf[i], 0);
      EXPECT_EQ(table.threshold[i], 0u);
    } else {
      EXPECT_GT(table.pmf[i], 0);
    }
    EXPECT_GT(weights[table.alias[i]], 0);
  }
}

TEST(AliasTable, million_entries) {
  std::mt19937 random(2);
  std::vector<double> weights(1'000'000);
  for (double& w : weights) w = std::exp(4 * (static_cast<double>(random()) * 0x1p-32));
  weights[123456] = 1e6;
  const auto table = make_alias_table(weights);
  const auto expected = shares(weights);
  std::vector<double> cells_naming(weights.size(), 1);
  for (const auto i : table.alias) ++cells_naming[i];
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    ASSERT_NEAR(table.pmf[i], expected[i], (1 + cells_naming[i]) * 0x1p-32 + expected[i] * 0x1p-23) << i;
    sum += table.pmf[i];
  }
  EXPECT_NEAR(sum, 1, 1e-7);
  EXPECT_EQ(count_all_choices(table), table.pmf);
}

TEST(AliasTable, bad_weights_throw) {
  const auto make = [](std::vector<double> weights) { make_alias_table(weights); };
  EXPECT_THROW(make({}), std::invalid_argument);
  EXPECT_THROW(make({0, 0}), std::invalid_argument);
  EXPECT_THROW(make({1, -1}), std::invalid_argument);
  EXPECT_THROW(make({1, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(make({1, std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

}  // namespace
}  // namespace etendue

// Fixed seeds; each bound fails by chance with probability below 1e-5. Seen to fail when: a group is only its
// first replicate; the last half is the first; the largest replicate is not taken less the mean.
#include "film/convergence.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

struct CheckedPicture {
  Film film;
  ReplicateLuminances luminances;
  ConvergenceChecks checks() const {
    return convergence_checks(film, luminances, {0, 0, film.width(), film.height()});
  }
};

CheckedPicture checked_picture(int side_px, int replicates,
                               const std::function<double(int replicate)>& draw) {
  CheckedPicture picture{Film(side_px, side_px), ReplicateLuminances(side_px, side_px, replicates)};
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      std::vector<Color<double>> means;
      for (int k = 0; k < replicates; ++k) {
        const double value = draw(k);
        means.push_back({value, value, value});
      }
      picture.film.at(x, y) = combine_replicates(means, 0);
      picture.luminances.add(x, y, 0, means);
    }
  return picture;
}

TEST(Convergence, SaysHowFarTheLargestReplicateWouldRaiseTheMean) {
  // Four pixels of mean 1; one has replicates 0, 0, 0, 4: a fifth replicate of 4 would make it 1.6.
  int drawn = 0;
  const CheckedPicture found = checked_picture(2, 4, [&](int) {
    const int i = drawn++;
    return i < 4 ? (i == 3 ? 4.0 : 0.0) : 1.0;
  });
  EXPECT_NEAR(found.checks().rise_by_largest, 0.6 / 4, 1e-6);
}

TEST(Convergence, FindsTheRootOfTheSamplesWhereReplicatesAreIndependent) {
  std::mt19937_64 engine(1);
  std::lognormal_distribution<double> law(0, 0.5);
  const ConvergenceChecks checks = checked_picture(64, 16, [&](int) { return law(engine); }).checks();
  EXPECT_NEAR(checks.slope, -0.5, 0.05);
  EXPECT_LT(checks.slope_low, checks.slope);
  EXPECT_NEAR(checks.slope_high - checks.slope, checks.slope - checks.slope_low, 1e-12);
  EXPECT_LT(checks.slope_high - checks.slope_low, 0.1);
}

TEST(Convergence, FindsASteeperSlopeWhereReplicatesComplementEachOther) {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> law(0, 1);
  // Each in its own stratum, two neighbours in opposite ones.
  const ConvergenceChecks checks =
      checked_picture(64, 8, [&](int k) { return (k % 2 == 0 ? k : 9 - k) + law(engine); }).checks();
  EXPECT_LT(checks.slope_high, -0.5);
}

TEST(Convergence, PValuesOfHalvesAreFlatWhereNothingChanges) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> law(5, 1);
  const ConvergenceChecks checks = checked_picture(64, 16, [&](int) { return law(engine); }).checks();
  EXPECT_EQ(checks.pixels_tested(), 64 * 64);
  for (const std::int64_t count : checks.p_values) EXPECT_NEAR(double(count), 409.6, 5 * std::sqrt(409.6));
  EXPECT_NEAR(double(checks.p_values_below_1_percent), 41, 5 * std::sqrt(41.0));
}

TEST(Convergence, PValuesOfHalvesGatherAtZeroWhereTheMeanDrifts) {
  std::mt19937_64 engine(4);
  std::normal_distribution<double> law(0, 1);
  const ConvergenceChecks checks =
      checked_picture(64, 16, [&](int k) { return 0.2 * k + law(engine); }).checks();
  EXPECT_GT(checks.p_values[0], 2000);
}

TEST(Convergence, IsUnknownOfOneReplicateAndWhereNoneAreKept) {
  EXPECT_TRUE(std::isnan(checked_picture(2, 1, [](int) { return 1.0; }).checks().rise_by_largest));
  const Film film = checked_picture(2, 8, [](int k) { return 1.0 + k; }).film;
  EXPECT_TRUE(std::isnan(convergence_checks(film, {}, {0, 0, 2, 2}).slope));
  EXPECT_TRUE(std::isnan(checked_picture(8, 2, [](int k) { return 1.0 + k; }).checks().slope));
}

}  // namespace
}  // namespace etendue

#include "film/region_mean.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

Film noisy_film(int side_px, double mean, double deviation, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> law(0, 1);
  Film film(side_px, side_px);
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      std::vector<Color<double>> means(8);
      for (Color<double>& each : means) {
        const double value = mean + deviation * law(engine);
        each = {value, value, value};
      }
      film.at(x, y) = combine_replicates(means, 0);
    }
  return film;
}

TEST(RegionMean, AddsTheSquaresOfThePixelsErrors) {
  const Film film = noisy_film(4, 2, 0.5, 1);
  const std::vector<PixelInterval> intervals = pixel_intervals(film, {}, 0.95);
  double mean = 0, error_sq = 0;
  for (int y = 1; y < 3; ++y)
    for (int x = 2; x < 4; ++x) {
      mean += film.at(x, y).mean.r / 4;
      error_sq += std::pow(standard_error(film.at(x, y)).r / 4, 2);
    }
  const RegionMean found = region_mean(film, intervals, {2, 1, 4, 3}, 0.95);
  EXPECT_NEAR(found.channels.r.mean, mean, 1e-12);
  EXPECT_NEAR(found.channels.r.error, std::sqrt(error_sq), 1e-12);
  EXPECT_NEAR(found.luminance.error, std::sqrt(error_sq), 1e-6);
  // Between 7 and 28 degrees of freedom.
  const double in_errors = (found.channels.r.interval.upper - mean) / found.channels.r.error;
  EXPECT_GT(in_errors, 2.04);
  EXPECT_LT(in_errors, 2.37);
}

TEST(RegionMean, HoldsTheTrueMeanInItsShareOfImages) {
  // 1000 images: fails by chance with probability 2e-6. Seen to fail when the errors are added, not their
  // squares.
  int covered = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Film film = noisy_film(3, 2, 0.5, seed);
    const Interval interval =
        region_mean(film, pixel_intervals(film, {}, 0.95), {0, 0, 3, 3}, 0.95).luminance.interval;
    covered += interval.lower <= 2 && 2 <= interval.upper;
  }
  EXPECT_GT(covered, 915);
  EXPECT_LT(covered, 983);
}

TEST(RegionMean, LeavesOutPixelsThatAreNotRendered) {
  Film film = noisy_film(2, 3, 0, 1);
  film.at(0, 0) = {};
  const RegionMean found = region_mean(film, pixel_intervals(film, {}, 0.95), {0, 0, 2, 2}, 0.95);
  EXPECT_EQ(found.channels.g.mean, 3);
  EXPECT_EQ(found.channels.g.interval.upper, 3);
  EXPECT_TRUE(std::isnan(
      region_mean(Film(1, 1), pixel_intervals(Film(1, 1), {}, 0.95), {0, 0, 1, 1}, 0.95).luminance.mean));
}

}  // namespace
}  // namespace etendue

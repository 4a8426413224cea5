// The tests of two images that `etendue verify` makes, on images made up.
//
// Fixed seeds: no test can fail by chance. Seen to fail when weights are not normalised, and when the number
// of replicates does not bound a pixel's p-value.
#include "verify/compare.h"
#include "verify/pilot_noise.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace etendue {
namespace {

constexpr int side = 64, replicates = 16;

/// Normal replicates: about `mean`, with `noise` of a replicate relative to it, by the pixel's column.
template <class Noise>
MomentImage normal_image(double mean, Noise&& noise, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  MomentImage image{side, side, {}, replicates};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      std::array<float, replicates> values;
      for (float& value : values) value = float(mean * (1 + noise(x) * normal(random)));
      image.pixels.push_back(moments_of_mean(values));
    }
  return image;
}

FilmCells film_of_one_material() {
  return film_cells(side, side, std::vector<std::int32_t>(side * side, 0), {0}, 1);
}

/// The left quarter is so noisy that the mean of the image tells nothing; the rest is known well.
double noisy_at_left(int x) { return x < side / 4 ? 20 : 0.05; }

std::vector<double> relative_variances(const FilmCells& film) {
  std::vector<double> of_cells;
  for (const FilmCell& cell : film.cells) {
    const double noise = noisy_at_left(cell.block % blocks_along(side) * block_side);
    of_cells.push_back(noise * noise);
  }
  return of_cells;
}

Comparison compared(const MomentImage& a, const MomentImage& b) {
  const FilmCells film = film_of_one_material();
  std::vector<double> means;
  for (const FilmCell& cell : film.cells) means.push_back(cell.pixels);
  const std::vector<double> relative = relative_variances(film),
                            weights = cell_weights(film, means, relative, 1, relative, 1);
  return compare(compared_image(a, film), compared_image(b, film), film, means, weights, 1e-5);
}

TEST(VerifyCompare, AFactorShowsWhereTheImageIsKnownBest) {
  const Comparison same = compared(normal_image(1, noisy_at_left, 1), normal_image(1, noisy_at_left, 2)),
                   apart = compared(normal_image(1, noisy_at_left, 3), normal_image(1.01, noisy_at_left, 4));
  EXPECT_GT(same.p_value, 1e-5);
  EXPECT_LT(same.smallest_difference, 0.01);
  EXPECT_LT(apart.p_value, 1e-8);
  EXPECT_TRUE(apart.strongest.region.is_weighted);
  EXPECT_NEAR(apart.strongest.ratio, 1 / 1.01, 0.003);
}

TEST(VerifyCompare, WeightsLeaveTheMeanAsItIs) {
  const FilmCells film = film_of_one_material();
  const std::vector<double> relative = relative_variances(film);
  std::vector<double> means;
  for (std::size_t k = 0; k < film.cells.size(); ++k) means.push_back(1 + double(k % 3));
  const std::vector<double> weights = cell_weights(film, means, relative, 4, relative, 8);
  double weighted = 0, sum = 0;
  for (std::size_t k = 0; k < means.size(); ++k) weighted += weights[k] * means[k], sum += means[k];
  EXPECT_NEAR(weighted, sum, 1e-9 * sum);
}

/// An edge through a pixel of a dim corner: of 4 replicates each, all of one image fell on one side, those of
/// the other on the other.
TEST(VerifyCompare, AFewReplicatesOfAPixelProveNothing) {
  const auto even = [](int) { return 0.1; };
  MomentImage a = normal_image(1, even, 5), b = normal_image(1, even, 6);
  const std::array<float, 4> bright{1.2f, 1.2001f, 1.2f, 1.1999f}, dark{0.8f, 0.8001f, 0.8f, 0.7999f};
  a.pixels[100] = moments_of_mean(bright);
  b.pixels[100] = moments_of_mean(dark);
  a.replicates = b.replicates = 64;
  const Comparison of_many = compared(a, b);
  EXPECT_EQ(of_many.strongest.region.kind, Region::Kind::pixel);
  EXPECT_LT(of_many.p_value, 1e-4);
  a.replicates = b.replicates = 4;
  EXPECT_GT(compared(a, b).p_value, 0.01);
}

TEST(VerifyCompare, CellsAreMaterialsAndWhatLiesNearGlossyOnes) {
  std::vector<std::int32_t> materials(side * side, 0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) materials[std::size_t(y * side + x)] = x < 8 ? 1 : y < 8 ? -1 : 0;
  const FilmCells film = film_cells(side, side, materials, {0, 1}, 2);
  int pixels[2][2] = {};
  for (const FilmCell& cell : film.cells)
    if (cell.material >= 0) pixels[cell.material][cell.has_rare_hits] += cell.pixels;
  EXPECT_EQ(pixels[1][1], 8 * side);
  EXPECT_EQ(pixels[1][0], 0);
  EXPECT_EQ(pixels[0][1], 2 * (side - 8));
  EXPECT_EQ(pixels[0][0], (side - 10) * (side - 8));
}

}  // namespace
}  // namespace etendue

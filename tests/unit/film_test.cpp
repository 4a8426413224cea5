#include "film/film.h"

#include "base/error.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

using Means = std::vector<Color<double>>;

Means uneven_means(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::lognormal_distribution<double> radiance(0, 2);
  Means means(count);
  for (auto& mean : means) mean = {radiance(engine), 1e3 * radiance(engine), 1e-3 * radiance(engine)};
  return means;
}

bool same_bits(const PixelStatistics& a, const PixelStatistics& b) {
  return a.count == b.count && std::memcmp(&a.mean, &b.mean, sizeof a.mean) == 0 &&
         std::memcmp(&a.m2, &b.m2, sizeof a.m2) == 0 && std::memcmp(&a.m3, &b.m3, sizeof a.m3) == 0;
}

PixelStatistics sum(const Means& all, std::size_t first, std::size_t last) {
  return combine_replicates(std::span(all).subspan(first, last - first), first);
}

TEST(Film, CombinesToTheMeanAndDeviationOfTheUnion) {
  const Means means{{1, 10, 2}, {2, 20, 2}, {6, 60, 2}};
  const PixelStatistics pixel = combine_replicates(means, 5);
  EXPECT_EQ(pixel.count, 3);
  EXPECT_DOUBLE_EQ(pixel.mean.r, 3);
  EXPECT_DOUBLE_EQ(pixel.mean.g, 30);
  EXPECT_EQ(pixel.mean.b, 2);
  EXPECT_DOUBLE_EQ(pixel.m2.r, 14);
  EXPECT_DOUBLE_EQ(pixel.m2.g, 1400);
  EXPECT_EQ(pixel.m2.b, 0);
  EXPECT_DOUBLE_EQ(pixel.m3.r, -8 - 1 + 27);
  EXPECT_DOUBLE_EQ(pixel.m3.g, 18e3);
  EXPECT_EQ(pixel.m3.b, 0);
  EXPECT_DOUBLE_EQ(standard_error(pixel).r, std::sqrt(14.0 / 2 / 3));
  EXPECT_EQ(standard_error(pixel).b, 0);
}

TEST(Film, KnowsNoErrorOfFewerThanTwoReplicates) {
  EXPECT_TRUE(std::isnan(standard_error(PixelStatistics{}).g));
  const PixelStatistics one = combine_replicates(Means{{1, 2, 3}}, 0);
  EXPECT_EQ(one.count, 1);
  EXPECT_EQ(one.mean, (Color<double>{1, 2, 3}));
  EXPECT_TRUE(std::isnan(standard_error(one).g));
}

TEST(Film, NothingChangesNothing) {
  const PixelStatistics some = combine_replicates(uneven_means(7, 1), 0);
  EXPECT_TRUE(same_bits(combine(some, {}), some));
  EXPECT_TRUE(same_bits(combine({}, some), some));
  EXPECT_EQ(combine_replicates({}, 3).count, 0);
}

TEST(Film, KeepsANaNInSight) {
  Means means = uneven_means(8, 1);
  means[3].g = std::nan("");
  const PixelStatistics pixel = combine_replicates(means, 0);
  EXPECT_TRUE(std::isnan(pixel.mean.g));
  EXPECT_TRUE(std::isnan(standard_error(pixel).g));
  EXPECT_FALSE(std::isnan(pixel.mean.r));
}

TEST(Film, SplitsRangesAtTheRoundestIndex) {
  EXPECT_EQ(replicate_split(0, 8), 4u);
  EXPECT_EQ(replicate_split(0, 5), 4u);
  EXPECT_EQ(replicate_split(3, 5), 4u);
  EXPECT_EQ(replicate_split(3, 4 + 128), 128u);
  EXPECT_EQ(replicate_split(12, 16), 14u);
  EXPECT_EQ(replicate_split(6, 8), 7u);
  EXPECT_EQ(replicate_split(0, ~0ull), 1ull << 63);
}

TEST(Film, MergesShardsAtTheSplitToTheBitsOfOneRun) {
  const Means all = uneven_means(80, 42);
  for (std::size_t first = 0; first < all.size(); ++first) {
    for (std::size_t last = first + 2; last <= all.size(); ++last) {
      const std::size_t split = replicate_split(first, last);
      ASSERT_TRUE(first < split && split < last) << first << ' ' << last;
      ASSERT_TRUE(same_bits(combine(sum(all, first, split), sum(all, split, last)), sum(all, first, last)))
          << first << ' ' << last;
    }
  }
}

TEST(Film, MergesAlignedBlocksInATreeToTheBitsOfOneRun) {
  const Means all = uneven_means(64, 43);
  for (std::size_t block = 1; block < 64; block *= 2) {
    std::vector<PixelStatistics> shards;
    for (std::size_t first = 0; first < 64; first += block) shards.push_back(sum(all, first, first + block));
    for (; shards.size() > 1; shards.resize(shards.size() / 2))
      for (std::size_t i = 0; i < shards.size() / 2; ++i)
        shards[i] = combine(shards[2 * i], shards[2 * i + 1]);
    EXPECT_TRUE(same_bits(shards[0], sum(all, 0, 64))) << block;
  }
}

TEST(Film, CutsElsewhereAgreeButForRounding) {
  const Means all = uneven_means(64, 44);
  const PixelStatistics whole = sum(all, 0, 64);
  bool any_differs = false;
  for (std::size_t cut = 1; cut < 64; ++cut) {
    const PixelStatistics merged = combine(sum(all, 0, cut), sum(all, cut, 64));
    any_differs |= !same_bits(merged, whole);
    EXPECT_NEAR(merged.mean.g, whole.mean.g, 1e-13 * whole.mean.g);
    EXPECT_NEAR(merged.m2.g, whole.m2.g, 1e-13 * whole.m2.g);
  }
  EXPECT_TRUE(any_differs) << "then the tests above show nothing";
}

TEST(Film, DoesNotDriftOverHugeCounts) {
  // 2^27 (1.3e8) replicates: a block of 1024 doubled by combining it with itself.
  PixelStatistics pixel = combine_replicates(uneven_means(1024, 45), 0);
  const PixelStatistics block = pixel;
  for (int i = 0; i < 17; ++i) pixel = combine(pixel, pixel);
  EXPECT_EQ(pixel.count, 1ll << 27);
  EXPECT_EQ(pixel.mean, block.mean);
  EXPECT_DOUBLE_EQ(pixel.m2.r, block.m2.r * double(1 << 17));
}

TEST(Film, MeanIsOverRenderedPixels) {
  Film film(3, 2);
  EXPECT_TRUE(std::isnan(film.mean().r));
  film.at(2, 0) = combine_replicates(Means{{1, 2, 3}, {3, 2, 1}}, 0);
  film.at(0, 1) = combine_replicates(Means{{4, 4, 4}}, 0);
  EXPECT_EQ(film.mean(), (Color<double>{3, 3, 3}));
  EXPECT_EQ(film.width(), 3);
  EXPECT_EQ(film.height(), 2);
}

TEST(Film, RefusesImpossibleSizes) {
  EXPECT_THROW(Film(0, 5), InputError);
  EXPECT_THROW(Film(5, -1), InputError);
}

}  // namespace
}  // namespace etendue

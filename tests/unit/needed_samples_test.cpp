// Each pixel takes what it needs where that is sharply known, and more where it is not, so that the share
// that was asked for has enough.
#include "film/needed_samples.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

constexpr int image_width = 64, image_height = 48;

/// Needs of 0.01 to 100 samples a replicate that are known to within `spread`.
NeededSamples needs(double spread) {
  std::mt19937_64 engine(5);
  std::lognormal_distribution<float> law(0, 2);
  NeededSamples needed{std::vector<float>(image_width * image_height), spread};
  for (float& need : needed.of_pixels) need = law(engine);
  return needed;
}

TEST(NeededSamples, GivesTheShareWhatItNeedsAndNoPixelMore) {
  const NeededSamples needed = needs(0);
  const SampleAllocation allocation = allocate_for_share(image_width, needed, 0.9, 1e6, 1 << 20);
  int have_enough = 0;
  for (int i = 0; i < image_width * image_height; ++i)
    have_enough += float(allocation.at(i % image_width, i / image_width)) >= needed.of_pixels[std::size_t(i)];
  EXPECT_NEAR(have_enough, 0.9 * image_width * image_height, 0.01 * image_width * image_height);
  EXPECT_EQ(expected_share(allocation, needed), double(have_enough) / (image_width * image_height));
  std::vector<float> in_order = needed.of_pixels;
  std::sort(in_order.begin(), in_order.end());
  EXPECT_LE(float(allocation.most()), 2 * in_order[std::size_t(0.9 * image_width * image_height)]);
  EXPECT_EQ(allocation.least(), 1);
}

TEST(NeededSamples, MakesUpForNeedsThatAreNotSharplyKnown) {
  for (const double spread : {0.2, 0.6}) {
    const NeededSamples needed = needs(spread);
    const SampleAllocation allocation = allocate_for_share(image_width, needed, 0.95, 1e6, 1 << 20);
    std::mt19937_64 engine(7);
    std::lognormal_distribution<float> off(0, float(spread));
    int have_enough = 0, drawn = 0;
    for (int round = 0; round < 10; ++round)
      for (int i = 0; i < image_width * image_height; ++i, ++drawn)
        have_enough += float(allocation.at(i % image_width, i / image_width)) >=
                       needed.of_pixels[std::size_t(i)] * off(engine);
    const double share = expected_share(allocation, needed);
    EXPECT_NEAR(have_enough, share * drawn, 5 * std::sqrt(share * (1 - share) * drawn)) << spread;
    EXPECT_GE(share, 0.95 - 0.5 / (image_width * image_height)) << spread;
    EXPECT_LT(share, 0.98) << spread;  // More by what the hardest pixels, which take the same, take at once.
  }
}

TEST(NeededSamples, SharesWhatThereIsWhereNeedsAreMore) {
  const NeededSamples needed = needs(0.3);
  const SampleAllocation allocation = allocate_for_share(image_width, needed, 0.99, 4, 1 << 20);
  EXPECT_LE(allocation.mean(), 4);
  EXPECT_GT(allocation.mean(), 2);
  EXPECT_LT(expected_share(allocation, needed), 0.99);
  NeededSamples far_off = needed;
  for (float& need : far_off.of_pixels) need *= 1e9f;
  EXPECT_LE(allocate_for_share(image_width, far_off, 0.99, 4, 1 << 20).mean(), 4);
  NeededSamples dark{std::vector<float>(image_width * image_height, 0), 0};
  EXPECT_EQ(allocate_for_share(image_width, dark, 1, 100, 64).most(), 1);
  dark.of_pixels[3] = 1e9f;
  EXPECT_EQ(allocate_for_share(image_width, dark, 1, 100, 64).most(), 64);
}

}  // namespace
}  // namespace etendue

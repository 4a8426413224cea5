// Covariances of parts with the whole, against sums over all replicates.
//
// Seen to fail when: deviations from means before and after a replicate are mixed up; each pass has means of
// its own.
#include "film/part_covariances.h"

#include <array>
#include <gtest/gtest.h>
#include <span>
#include <utility>

namespace etendue {
namespace {

TEST(PartCovariances, AreThoseOfAllReplicatesInPasses) {
  constexpr std::size_t replicates = 7, parts = 2;
  std::array<std::array<Color<double>, replicates>, parts> part;
  std::array<Color<double>, replicates> image;
  for (std::size_t r = 0; r < replicates; ++r) {
    part[0][r] = {1000.0 + double(r * r), 3, double(r)};
    part[1][r] = {5, double(r % 3), 900.0 - double(r)};
    image[r] = part[0][r] + part[1][r];
  }
  std::array<double, 1 + parts> sums{};
  PartCovariances covariances(3, 2, parts);
  for (const auto& [first, count] : {std::pair{0, 1}, {1, 4}, {5, 2}})
    covariances.add(2, 1, std::span(image).subspan(std::size_t(first), std::size_t(count)),
                    &part[0][std::size_t(first)], replicates, sums);

  const auto covariance = [&](const std::array<Color<double>, replicates>& a) {
    double mean_a = 0, mean_image = 0, sum = 0;
    for (std::size_t r = 0; r < replicates; ++r) {
      mean_a += luminance(a[r]) / replicates;
      mean_image += luminance(image[r]) / replicates;
    }
    for (std::size_t r = 0; r < replicates; ++r)
      sum += (luminance(a[r]) - mean_a) * (luminance(image[r]) - mean_image);
    return sum;
  };
  EXPECT_NEAR(sums[0], covariance(image), 1e-9);
  for (std::size_t k = 0; k < parts; ++k) EXPECT_NEAR(sums[k + 1], covariance(part[k]), 1e-9);
  EXPECT_NEAR(sums[1] + sums[2], sums[0], 1e-9);
}

}  // namespace
}  // namespace etendue

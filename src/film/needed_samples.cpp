#include "film/needed_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace etendue {

double expected_share(const SampleAllocation& allocation, const NeededSamples& needed) {
  double sum = 0;
  for (int y = 0, i = 0; y < allocation.height(); ++y)
    for (int x = 0; x < allocation.width(); ++x, ++i) {
      const double ratio = double(allocation.at(x, y)) / double(needed.of_pixels[std::size_t(i)]);
      sum += needed.spread > 0 ? 0.5 * std::erfc(-std::log(ratio) / (std::numbers::sqrt2 * needed.spread))
                               : double(ratio >= 1);
    }
  return sum / double(needed.of_pixels.size());
}

SampleAllocation allocate_for_share(int width, const NeededSamples& needed, double share, double mean,
                                    int most) {
  constexpr double least_multiple = -40, most_multiple = 10,
                   resolution = 1e-3;  // Of their logarithms to base 2.
  std::vector<float> in_order = needed.of_pixels;
  const std::size_t count = in_order.size();
  const auto end_of_share =
      in_order.begin() + std::clamp(std::ptrdiff_t(std::ceil(share * double(count))) - 1, std::ptrdiff_t(0),
                                    std::ptrdiff_t(count) - 1);
  std::nth_element(in_order.begin(), end_of_share, in_order.end());
  const float most_needed = *end_of_share;
  const auto multiplied = [&](double logarithm) {
    const double multiple = std::exp2(logarithm);
    SampleAllocation allocation(width, int(count) / width, 1);
    for (int y = 0, i = 0; y < allocation.height(); ++y)
      for (int x = 0; x < width; ++x, ++i) {
        const double samples = multiple * double(std::min(needed.of_pixels[std::size_t(i)], most_needed));
        allocation.at(x, y) = int(std::bit_ceil(unsigned(std::ceil(std::clamp(samples, 1.0, double(most))))));
      }
    return allocation;
  };
  const auto is_enough = [&](const SampleAllocation& allocation) {
    return expected_share(allocation, needed) >= share - 0.5 / double(count) || allocation.mean() > mean;
  };
  double too_few = least_multiple, enough = most_multiple;
  while (enough - too_few > resolution) {
    const double middle = (too_few + enough) / 2;
    (is_enough(multiplied(middle)) ? enough : too_few) = middle;
  }
  const SampleAllocation allocation = multiplied(enough);
  return allocation.mean() > mean ? multiplied(too_few) : allocation;
}

}  // namespace etendue

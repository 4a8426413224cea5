#include "film/sample_allocation.h"

#include "base/hash.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace etendue {

SampleAllocation::SampleAllocation(int width, int height, int samples_per_replicate)
    : width_(width), counts_(std::size_t(width) * std::size_t(height), samples_per_replicate) {}

int SampleAllocation::least() const { return *std::min_element(counts_.begin(), counts_.end()); }
int SampleAllocation::most() const { return *std::max_element(counts_.begin(), counts_.end()); }

double SampleAllocation::mean() const {
  return std::accumulate(counts_.begin(), counts_.end(), 0.0) / double(counts_.size());
}

SampleAllocation allocate(int width, std::span<const float> weights, double mean, int most) {
  constexpr double never = -1e9;
  // Where many pixels weigh the same, as many are doubled as there are samples for, scattered over the image.
  constexpr double tie_break = 1e-3;
  std::vector<double> logarithms(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    logarithms[i] =
        weights[i] > 0 ? std::log2(double(weights[i])) + tie_break * 0x1p-64 * double(hash64(i)) : never;
  const int most_doublings = std::bit_width(unsigned(most)) - 1;
  const auto count = [&](double logarithm, double scale) {
    return 1 << int(std::ceil(std::clamp(logarithm + scale, 0.0, double(most_doublings))));
  };
  const double affordable = mean * double(weights.size());
  const auto is_affordable = [&](double scale) {
    double sum = 0;
    for (const double logarithm : logarithms) sum += count(logarithm, scale);
    return sum <= affordable;
  };
  double scale = -400, too_much = 400;  // Floats are 2^-149 to 2^128.
  while (too_much - scale > 1e-9) {
    const double middle = (scale + too_much) / 2;
    (is_affordable(middle) ? scale : too_much) = middle;
  }
  SampleAllocation allocation(width, int(weights.size()) / width, 1);
  for (int y = 0, i = 0; y < allocation.height(); ++y)
    for (int x = 0; x < width; ++x, ++i) allocation.at(x, y) = count(logarithms[std::size_t(i)], scale);
  return allocation;
}

}  // namespace etendue

#include "film/replicate_luminances.h"

#include <algorithm>

namespace etendue {

ReplicateLuminances::ReplicateLuminances(int width, int height, int replicates)
    : width_(width), height_(height), is_kept_(true) {
  make_room(replicates);
}

void ReplicateLuminances::make_room(int replicates) {
  if (!is_kept_ || replicates <= replicates_) return;
  const std::size_t pixels = std::size_t(width_) * std::size_t(height_),
                    most = most_bytes / sizeof(float) / std::max<std::size_t>(pixels, 1);
  if (std::size_t(replicates) > most) {
    *this = {};
    return;
  }
  // Twice as many, so that each value is moved a few times at most.
  const std::size_t room = std::min(most, std::max(std::size_t(replicates), 2 * std::size_t(replicates_)));
  std::vector<float> roomy(pixels * room);
  for (std::size_t pixel = 0; pixel < pixels && replicates_ > 0; ++pixel)
    std::copy_n(values_.begin() + std::ptrdiff_t(pixel * std::size_t(replicates_)), replicates_,
                roomy.begin() + std::ptrdiff_t(pixel * room));
  values_ = std::move(roomy);
  replicates_ = int(room);
}

void ReplicateLuminances::add(int x, int y, std::int64_t first, std::span<const Color<double>> means) {
  if (!is_kept()) return;
  float* at = values_.data() + offset(x, y) + first;
  for (const Color<double>& mean : means) *at++ = float(luminance(mean));
}

RunningStatistics statistics_of(std::span<const float> luminances) {
  RunningStatistics statistics{std::int64_t(luminances.size()), 0, 0, 0};
  for (const float value : luminances) statistics.mean += value;
  statistics.mean /= double(luminances.size());
  for (const float value : luminances) statistics.m2 += (value - statistics.mean) * (value - statistics.mean);
  return statistics;
}

}  // namespace etendue

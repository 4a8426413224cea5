#include "film/replicate_luminances.h"

namespace etendue {

ReplicateLuminances::ReplicateLuminances(int width, int height, int replicates)
    : width_(width), replicates_(replicates) {
  const std::size_t count = std::size_t(width) * std::size_t(height) * std::size_t(replicates);
  if (count <= most_bytes / sizeof(float)) values_.resize(count);
}

void ReplicateLuminances::add(int x, int y, std::int64_t first, std::span<const Color<double>> means) {
  if (!is_kept()) return;
  float* at = values_.data() + offset(x, y) + first;
  for (const Color<double>& mean : means) *at++ = float(luminance(mean));
}

}  // namespace etendue

// What a render is made of: pixels, and which samples of each.
#pragma once

#include "film/pixel_rectangle.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Replicates [first_replicate, first_replicate + replicates) of some pixels. No bit of them depends on how
/// an image is cut into units.
struct WorkUnit {
  PixelRectangle pixels;
  std::int64_t first_replicate = 0;
  int replicates = 1, samples_per_replicate = 1;

  std::int64_t samples_per_pixel() const { return std::int64_t(replicates) * samples_per_replicate; }
};

/// `whole` cut into tiles: small enough for every thread to have several, and for a stop to be obeyed soon.
std::vector<WorkUnit> tiles_of(const WorkUnit& whole, int threads);

}  // namespace etendue

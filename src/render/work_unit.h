// What a render is made of: pixels, and which samples of each.
#pragma once

#include "film/pixel_rectangle.h"
#include "film/sample_allocation.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Replicates [first_replicate, first_replicate + replicates) of some pixels. No bit of them depends on how
/// an image is cut into units.
struct WorkUnit {
  PixelRectangle pixels;
  std::int64_t first_replicate = 0;
  int replicates = 1;
  int samples_per_replicate = 1;  ///< Of each pixel, where there is no allocation.
  const SampleAllocation* allocation = nullptr;

  int samples_per_replicate_of(int x, int y) const {
    return allocation ? allocation->at(x, y) : samples_per_replicate;
  }
  std::int64_t samples() const;  ///< Of all its pixels.
};

/// `whole` cut into tiles: small enough for every thread to have several, and for a stop to be obeyed soon.
std::vector<WorkUnit> tiles_of(const WorkUnit& whole, int threads);

}  // namespace etendue

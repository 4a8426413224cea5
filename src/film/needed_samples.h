// How many samples each pixel needs, and takes so that a share of them has enough.
#pragma once

#include "film/sample_allocation.h"

#include <vector>

namespace etendue {

/// Samples a replicate that each pixel needs, as far as that is known.
struct NeededSamples {
  std::vector<float> of_pixels;  ///< Rows from the top: finite, not negative.
  double spread = 0;  ///< Standard deviation of the logarithm of what a pixel truly needs about that.
};

/// The expected share of the pixels that have as many samples as they truly need, whose logarithm is normal.
double expected_share(const SampleAllocation& allocation, const NeededSamples& needed);

/// Of the allocations that give each pixel the same multiple of what it needs, rounded up to a power of two,
/// that of the least multiple by which `share` of the pixels are expected to have enough. No pixel takes more
/// than the one where the share ends, in the order of what they need.
/// \param share in (0, 1]; half a pixel may be missing
/// \param mean of all pixels, at least 1: no more is allocated, though fewer pixels have enough then
/// \param most samples a replicate, a power of two
SampleAllocation allocate_for_share(int width, const NeededSamples& needed, double share, double mean,
                                    int most);

}  // namespace etendue

// How many samples each pixel of an image takes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Samples per replicate of each pixel; all pixels have the same replicates.
class SampleAllocation {
 public:
  SampleAllocation(int width, int height, int samples_per_replicate);

  int width() const { return width_; }
  int height() const { return int(counts_.size()) / width_; }
  int at(int x, int y) const { return counts_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
  int& at(int x, int y) { return counts_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }

  int least() const;
  int most() const;
  double mean() const;

 private:
  int width_;
  std::vector<int> counts_;
};

/// Powers of two, as whole nets are the best distributed, in proportion to `weights` as nearly as these
/// allow. If the variance of one sample of a pixel is the square of its weight, the sum of the variances of
/// all pixels is least for that many samples (Neyman 1934, "On the two different aspects of the
/// representative method", allocation to strata).
/// \param weights of each pixel, rows from the top: finite, not negative; a pixel of weight 0 takes 1
/// \param mean of all pixels, at least 1; what is allocated is at most that, and less by at most one doubling
///   unless all pixels have `most`
/// \param most samples a replicate, a power of two
SampleAllocation allocate(int width, std::span<const float> weights, double mean, int most);

}  // namespace etendue

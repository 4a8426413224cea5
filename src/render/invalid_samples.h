// The samples that a render could not use.
#pragma once

#include "base/color.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue {

/// A sample whose radiance was NaN, infinite or negative; it counts as zero in its pixel.
struct InvalidSample {
  int x, y;
  std::int64_t replicate, index;  ///< The index counts within the replicate.
  Colorf radiance;
};

/// How many there were, and the first of them by row, column, replicate and index: the same ones however the
/// work was divided.
class InvalidSamples {
 public:
  static constexpr std::size_t most_noted = 16;

  void add(const InvalidSample& sample);
  void add(const InvalidSamples& others);

  std::int64_t count() const { return count_; }
  const std::vector<InvalidSample>& first() const { return first_; }  ///< At most `most_noted`, in order.

 private:
  void note(const InvalidSample& sample);

  std::int64_t count_ = 0;
  std::vector<InvalidSample> first_;
};

}  // namespace etendue

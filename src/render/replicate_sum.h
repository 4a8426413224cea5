// The sum of one replicate's samples, in an order that depends on their indices alone.
#pragma once

#include <array>

namespace etendue {

/// Sums a replicate's samples in an order that depends on their indices alone.
class ReplicateSum {
 public:
  /// Adds values[0 .. count - 1], the samples `first_index`, `first_index` + 1 ...
  void add(const float* values, int count, int first_index) {
    int i = 0;
    for (; i < count && (first_index + i) % slots != 0; ++i) slot_[(first_index + i) % slots] += values[i];
    for (; i + slots <= count; i += slots)
      for (int s = 0; s < slots; ++s) slot_[s] += values[i + s];
    for (; i < count; ++i) slot_[(first_index + i) % slots] += values[i];
  }
  /// The sum so far; starts anew.
  double take() {
    for (int half = slots / 2; half > 0; half /= 2)
      for (int s = 0; s < half; ++s) slot_[s] += slot_[s + half];
    const double total = slot_[0];
    slot_.fill(0);
    return total;
  }

 private:
  static constexpr int slots = 8;
  std::array<double, slots> slot_{};
};

struct ReplicateColorSum {
  ReplicateSum r, g, b;
};

}  // namespace etendue

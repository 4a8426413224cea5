// A density of straight lines between whole numbers: places drawn from it, and its height there.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"

#include <array>

namespace etendue {

/// Over 0 .. parts, not normalised.
template <class F, std::size_t parts>
class PiecewiseLinear {
 public:
  PiecewiseLinear() = default;
  /// \param heights at the whole numbers, >= 0, not all 0
  explicit PiecewiseLinear(const std::array<F, parts + 1>& heights) : heights_(heights) {
    before_[0] = F(0);
    for (std::size_t k = 0; k < parts; ++k)
      before_[k + 1] = before_[k] + F(0.5f) * (heights_[k] + heights_[k + 1]);
  }

  const F& integral() const { return before_[parts]; }

  struct Drawn {
    F place, height;  ///< 0 .. parts; of the density there.
  };
  /// Rises with u, 0 .. 1.
  Drawn sample(const F& u) const {
    const F target = u * integral();
    F before(0), first = heights_[0], last = heights_[1], number(0);
    for (std::size_t k = 1; k < parts; ++k) {
      const Mask<F> is_beyond = target >= before_[k];
      before = select(is_beyond, before_[k], before);
      first = select(is_beyond, heights_[k], first);
      last = select(is_beyond, heights_[k + 1], last);
      number = select(is_beyond, F(float(k)), number);
    }
    const F rest = F(2) * max(target - before, F(0));
    const F height = sqrt(max(first * first + rest * (last - first), F(0)));
    return {number + min(rest / max(first + height, F(1e-30f)), F(1)), height};
  }

  F height(const F& place) const {
    F height = heights_[0];
    for (std::size_t k = 1; k <= parts; ++k)
      height = height + (heights_[k] - heights_[k - 1]) * max(min(place - F(float(k - 1)), F(1)), F(0));
    return height;
  }

 private:
  std::array<F, parts + 1> heights_, before_;
};

}  // namespace etendue

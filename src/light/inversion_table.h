// Discrete distributions sampled by inversion, which keeps the order of the random numbers and so their
// stratification (alias_table.h is faster and does not).
#pragma once

#include "base/gather.h"
#include "base/simd_math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Cumulative shares are whole numbers out of this, so that the probability of an entry is what sampling
/// does: exact, and 0 for what is never chosen.
inline constexpr std::int32_t inversion_whole = 1 << 30;

/// Appends n + 1 cumulative shares of `weights`, the first 0, the last `inversion_whole`; all 0 where all
/// weights are. Weights must be finite and not negative.
void append_cumulative_shares(std::span<const double> weights, std::vector<std::int32_t>& shares);

/// The same, but none of a positive weight has less than about `least_share`, in [2^-28, 1), however small it
/// is among the others: shares are whole numbers, and what rounds to 0 would be left out. All alike where all
/// weights are 0.
void append_positive_shares(std::vector<double> weights, std::vector<std::int32_t>& shares,
                            double least_share = 0x1p-28);

template <class F>
struct InversionSample {
  Int<F> index;
  F u_left;  ///< In [0, 1): the place of the random number within its entry.
};

/// Chooses one of `count` entries whose shares begin at shares[first]: the last that begins at or before u.
/// \param most no lane has more
template <class F>
InversionSample<F> sample_by_inversion(const std::int32_t* shares, const Int<F>& first, const Int<F>& count,
                                       std::int32_t most, const UInt<F>& u) {
  using I = Int<F>;
  const I wanted = as_int(u >> 2);
  I index(0);
  std::int32_t step = 1;
  while (step < most) step *= 2;
  while ((step /= 2) > 0) {
    const I probe = index + I(step);
    const Mask<F> is_inside = less(probe, count);
    const I begin = gather(shares, first + select(is_inside, probe, I(0)));
    index = select(mask_and(is_inside, mask_not(less(wanted, begin))), probe, index);
  }
  const I begin = gather(shares, first + index), end = gather(shares, first + index + I(1));
  const F below = (to_float(as_int(u & UInt<F>(3u))) + F(0.5f)) * F(0.25f);
  const F u_left = (to_float(wanted - begin) + below) / to_float(end - begin);
  return {index, min(u_left, F(0x1.fffffep-1f))};
}

/// The same number of entries in every lane.
template <class F>
InversionSample<F> sample_by_inversion(const std::int32_t* shares, const Int<F>& first, std::int32_t count,
                                       const UInt<F>& u) {
  return sample_by_inversion<F>(shares, first, Int<F>(count), count, u);
}

/// The probability of entry `index`, out of 1.
template <class F>
F inversion_pmf(const std::int32_t* shares, const Int<F>& first, const Int<F>& index) {
  const Int<F> at = first + index;
  return to_float(gather(shares, at + Int<F>(1)) - gather(shares, at)) * F(1.0f / float(inversion_whole));
}

}  // namespace etendue

// A discrete distribution sampled in constant time: Walker's alias method as built by Vose (1991).
#pragma once

#include "base/gather.h"
#include "base/simd_math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// n cells, all equally likely; cell i yields entry i where the fraction is below threshold[i], else
/// alias[i].
///
/// u is a 32-bit integer, so that every entry is chosen by a whole number of its 2^32 values: `pmf` is that
/// number over 2^32, what sampling does, not what the weights asked for. The two differ by at most about (1 +
/// cells that name the entry) / 2^32. An entry with pmf 0 is never chosen: all of weight zero, and others
/// only where their share is about 1 / 2^32 or less.
struct AliasTable {
  std::vector<std::uint32_t> threshold;  ///< Fixed point, in units of 2^-32 of a cell.
  std::vector<std::int32_t> alias;
  std::vector<float> pmf;  ///< Sums to 1.

  std::size_t size() const { return pmf.size(); }
};

/// Throws std::invalid_argument where there is no weight, 2^31 or more of them, a negative or non-finite one,
/// or none above zero. M. D. Vose, "A linear algorithm for generating random numbers with a given
/// distribution", 1991.
AliasTable make_alias_table(std::span<const double> weights);

template <class F>
struct AliasSample {
  Int<F> index;
  F u_left;  ///< In [0, 1), uniform; it has about 32 - log2(n) random bits, 24 at most.
};

/// Chooses one of `count` entries whose cells begin at threshold[first] and alias[first]: cell = upper,
/// fraction = lower 32 bits of the product u n.
template <class F>
AliasSample<F> sample_alias(const std::uint32_t* threshold, const std::int32_t* alias, const Int<F>& first,
                            const Int<F>& count, const UInt<F>& u) {
  const Int<F> cell = as_int(mul_hi(u, as_uint(count)));
  const UInt<F> fraction = u * as_uint(count);
  const UInt<F> split = gather(threshold, first + cell);
  const Mask<F> is_own = less(fraction, split);
  const F left = to_unit_float(fraction), split_share = to_unit_float(split);
  const F stretched = select(is_own, left, left - split_share) /
                      max(select(is_own, split_share, F(1) - split_share), F(0x1p-24f));
  return {select(is_own, cell, gather(alias, first + cell)), min(max(stretched, F(0)), F(0x1.fffffep-1f))};
}

}  // namespace etendue

// A discrete distribution sampled in constant time: Walker's alias method as built by Vose (1991).
#pragma once

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
  struct Sample {
    std::uint32_t index;
    float u_remapped;  ///< In [0, 1), uniform; it has about 32 - log2(n) random bits, 24 at most.
  };

  std::vector<std::uint32_t> threshold;  ///< Fixed point, in units of 2^-32 of a cell.
  std::vector<std::uint32_t> alias;
  std::vector<float> pmf;  ///< Sums to 1.

  std::size_t size() const { return pmf.size(); }

  /// Cell = upper, fraction = lower 32 bits of the product u n.
  Sample sample(std::uint32_t u) const;
};

/// Throws std::invalid_argument where there is no weight, 2^32 or more of them, a negative or non-finite one,
/// or none above zero. M. D. Vose, "A linear algorithm for generating random numbers with a given
/// distribution", 1991.
AliasTable make_alias_table(std::span<const double> weights);

}  // namespace etendue

// Owen-scrambled Sobol points in two dimensions, by hashing: Burley 2020, "Practical hash-based Owen
// scrambling".
#pragma once

#include "base/bits.h"
#include "base/vec.h"

namespace etendue {

/// Owen scrambling of a number whose bits are reversed (most significant digit in bit 0): every bit is
/// flipped by a hash of the bits below it. Constants of Vegdahl 2021, "Building a better LK hash", the short
/// variant.
template <class U>
U scramble_reversed(U x, const U& seed) {
  x = x ^ (x * U(0x3d20adeau));
  x = x + seed;
  x = x * ((seed >> 16) | U(1));
  x = x ^ (x * U(0x05526c56u));
  x = x ^ (x * U(0x53a22864u));
  return x;
}

/// The second Sobol dimension of `index`, bits reversed: its generator matrix is Pascal's triangle modulo 2,
/// which factors into five steps.
template <class U>
U sobol_second_reversed(U index) {
  index = index ^ (index >> 16);
  index = index ^ ((index & U(0xff00ff00u)) >> 8);
  index = index ^ ((index & U(0xf0f0f0f0u)) >> 4);
  index = index ^ ((index & U(0xccccccccu)) >> 2);
  return index ^ ((index & U(0xaaaaaaaau)) >> 1);
}

/// The point `index` of an Owen-scrambled (0,2)-sequence as 32-bit fractions. Padded dimensions get another
/// `seed_order`, which shuffles the sequence by a nested uniform scramble of the index.
template <class U>
Vec2<U> owen_sobol_2d(const U& index, const U& seed_order, const U& seed_x, const U& seed_y) {
  const U shuffled = reverse_bits(scramble_reversed(reverse_bits(index), seed_order));
  // The first dimension is the radical inverse: the index is its own reversed form.
  return {reverse_bits(scramble_reversed(shuffled, seed_x)),
          reverse_bits(scramble_reversed(sobol_second_reversed(shuffled), seed_y))};
}

}  // namespace etendue

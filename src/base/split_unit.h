// Two random numbers out of one.
#pragma once

#include "base/hash.h"
#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

/// Two independent uniform numbers in [0, 1) from one (of 24 bits, as to_unit_float gives): each takes every
/// other bit, so that points stratified over the interval come out stratified over the square; a hash fills
/// the bits below.
template <class F>
Vec2<F> split_unit(const F& u) {
  using U = UInt<F>;
  const U bits = as_uint(to_int(u * F(0x1p24f))), fill = hash32(bits);
  const auto every_other_bit = [](U x) {
    x = x & U(0x555555u);
    x = (x | (x >> 1)) & U(0x333333u);
    x = (x | (x >> 2)) & U(0x0f0f0fu);
    x = (x | (x >> 4)) & U(0xff00ffu);
    return (x | (x >> 8)) & U(0xfffu);
  };
  const U x = (every_other_bit(bits >> 1) << 12) | (fill >> 20),
          y = (every_other_bit(bits) << 12) | ((fill >> 8) & U(0xfffu));
  return {to_float(as_int(x)) * F(0x1p-24f), to_float(as_int(y)) * F(0x1p-24f)};
}

}  // namespace etendue

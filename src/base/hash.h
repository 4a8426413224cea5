// Integer hashes over lanes: random bits that are a pure function of their key.
#pragma once

#include "base/simd.h"

namespace etendue {

/// A bijection of 32 bits with low bias ("lowbias32", C. Wellons, Hash Prospector, 2018).
template <class U>
U hash32(U x) {
  x = x ^ (x >> 16);
  x = x * U(0x7feb352du);
  x = x ^ (x >> 15);
  x = x * U(0x846ca68bu);
  x = x ^ (x >> 16);
  return x;
}

/// A bijection of 64 bits (splitmix64's finaliser, Steele, Lea and Flood 2014).
inline std::uint64_t hash64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace etendue

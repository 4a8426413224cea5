// Masks, comparisons and conversions of lanes.
#pragma once

#include "base/simd.h"

namespace etendue {

inline float select(bool m, float a, float b) { return m ? a : b; }
inline std::int32_t select(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
template <class A>
xsimd::batch<float, A> select(const xsimd::batch_bool<float, A>& m, const xsimd::batch<float, A>& a,
                              const xsimd::batch<float, A>& b) {
  return xsimd::select(m, a, b);
}
template <class A>
xsimd::batch<std::int32_t, A> select(const xsimd::batch_bool<float, A>& m,
                                     const xsimd::batch<std::int32_t, A>& a,
                                     const xsimd::batch<std::int32_t, A>& b) {
  return xsimd::select(lanes::mask_for_ints(m), a, b);
}

inline bool any(bool m) { return m; }
template <class A>
bool any(const xsimd::batch_bool<float, A>& m) {
  return xsimd::any(m);
}
inline bool all(bool m) { return m; }
template <class A>
bool all(const xsimd::batch_bool<float, A>& m) {
  return xsimd::all(m);
}

inline bool mask_and(bool a, bool b) { return a && b; }
template <class A>
xsimd::batch_bool<float, A> mask_and(const xsimd::batch_bool<float, A>& a,
                                     const xsimd::batch_bool<float, A>& b) {
  return a & b;
}
inline bool mask_or(bool a, bool b) { return a || b; }
template <class A>
xsimd::batch_bool<float, A> mask_or(const xsimd::batch_bool<float, A>& a,
                                    const xsimd::batch_bool<float, A>& b) {
  return a | b;
}
inline bool mask_not(bool a) { return !a; }
template <class A>
xsimd::batch_bool<float, A> mask_not(const xsimd::batch_bool<float, A>& a) {
  return !a;
}
template <class M, class... Ms>
M mask_and(const M& a, const M& b, const Ms&... rest) {
  return mask_and(mask_and(a, b), rest...);
}

/// Integer comparisons as a mask for floats.
inline bool equal(std::int32_t a, std::int32_t b) { return a == b; }
template <class A>
xsimd::batch_bool<float, A> equal(const xsimd::batch<std::int32_t, A>& a,
                                  const xsimd::batch<std::int32_t, A>& b) {
  return lanes::mask_for_floats(a == b);
}
inline bool less(std::int32_t a, std::int32_t b) { return a < b; }
template <class A>
xsimd::batch_bool<float, A> less(const xsimd::batch<std::int32_t, A>& a,
                                 const xsimd::batch<std::int32_t, A>& b) {
  return lanes::mask_for_floats(a < b);
}
inline bool less(std::uint32_t a, std::uint32_t b) { return a < b; }
/// Unsigned: both are shifted into the signed range, because SSE and AVX2 compare signed only.
template <class A>
xsimd::batch_bool<float, A> less(const xsimd::batch<std::uint32_t, A>& a,
                                 const xsimd::batch<std::uint32_t, A>& b) {
  const xsimd::batch<std::uint32_t, A> sign(0x80000000u);
  return less(lanes::recast<std::int32_t>(a ^ sign), lanes::recast<std::int32_t>(b ^ sign));
}

/// A mask in memory is -1 (set) or 0 an element, as the ray caster wants it.
template <class F>
void store_mask(std::int32_t* p, const Mask<F>& m) {
  store_lanes(p, select(m, Int<F>(-1), Int<F>(0)));
}
template <class F>
Mask<F> load_mask(const std::int32_t* p) {
  return less(load_lanes<Int<F>>(p), Int<F>(0));
}

// --- conversions ---

/// Truncates towards zero.
inline std::int32_t to_int(float v) { return std::int32_t(v); }
inline float to_float(std::int32_t v) { return float(v); }
inline std::int32_t as_int(std::uint32_t v) { return std::int32_t(v); }
inline std::uint32_t as_uint(std::int32_t v) { return std::uint32_t(v); }
inline float bits_as_float(std::uint32_t v) { return std::bit_cast<float>(v); }
inline std::uint32_t float_as_bits(float v) { return std::bit_cast<std::uint32_t>(v); }
template <class A>
xsimd::batch<std::int32_t, A> to_int(const xsimd::batch<float, A>& v) {
  return xsimd::to_int(v);
}
template <class A>
xsimd::batch<float, A> to_float(const xsimd::batch<std::int32_t, A>& v) {
  return xsimd::to_float(v);
}
template <class A>
xsimd::batch<std::int32_t, A> as_int(const xsimd::batch<std::uint32_t, A>& v) {
  return lanes::recast<std::int32_t>(v);
}
template <class A>
xsimd::batch<std::uint32_t, A> as_uint(const xsimd::batch<std::int32_t, A>& v) {
  return lanes::recast<std::uint32_t>(v);
}
template <class A>
xsimd::batch<float, A> bits_as_float(const xsimd::batch<std::uint32_t, A>& v) {
  return lanes::recast<float>(v);
}
template <class A>
xsimd::batch<std::uint32_t, A> float_as_bits(const xsimd::batch<float, A>& v) {
  return lanes::recast<std::uint32_t>(v);
}

}  // namespace etendue

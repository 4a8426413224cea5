// Lanes: one float, or a batch of floats, behind the same names. The only file that knows xsimd.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <xsimd/xsimd.hpp>

namespace etendue {

#ifdef ETENDUE_SCALAR_LANES
using NativeLanes = float;
#else
/// The widest batch of the instruction set that this translation unit is compiled for.
using NativeLanes = xsimd::batch<float>;
#endif

/// The integer and mask types that go with a lane type `F`.
template <class F>
struct LaneTypes;

template <>
struct LaneTypes<float> {
  using Int = std::int32_t;
  using UInt = std::uint32_t;
  using Mask = bool;
  static constexpr int count = 1;
};

template <class A>
struct LaneTypes<xsimd::batch<float, A>> {
  using Int = xsimd::batch<std::int32_t, A>;
  using UInt = xsimd::batch<std::uint32_t, A>;
  using Mask = xsimd::batch_bool<float, A>;
  static constexpr int count = int(xsimd::batch<float, A>::size);
};

template <class F>
using Int = typename LaneTypes<F>::Int;
template <class F>
using UInt = typename LaneTypes<F>::UInt;
template <class F>
using Mask = typename LaneTypes<F>::Mask;
template <class F>
inline constexpr int lane_count_v = LaneTypes<F>::count;

namespace lanes {  // The places where releases of xsimd differ.
/// Reinterprets the bits of every lane.
template <class To, class From, class A>
xsimd::batch<To, A> recast(const xsimd::batch<From, A>& v) {
#if XSIMD_VERSION_MAJOR >= 10
  return xsimd::bitwise_cast<To>(v);
#else
  return xsimd::bitwise_cast<xsimd::batch<To, A>>(v);
#endif
}
#if XSIMD_VERSION_MAJOR >= 9
template <class A>
auto mask_for_floats(const xsimd::batch_bool<std::int32_t, A>& m) {
  return xsimd::batch_bool_cast<float>(m);
}
template <class A>
auto mask_for_ints(const xsimd::batch_bool<float, A>& m) {
  return xsimd::batch_bool_cast<std::int32_t>(m);
}
#else
template <class A>
auto mask_for_floats(const xsimd::batch_bool<std::int32_t, A>& m) {
  return xsimd::bool_cast(m);
}
template <class A>
auto mask_for_ints(const xsimd::batch_bool<float, A>& m) {
  return xsimd::bool_cast(m);
}
#endif
}  // namespace lanes

// --- memory: `p` is aligned to the batch for load_lanes and store_lanes ---

inline void store_lanes(float* p, float v) { *p = v; }
inline void store_lanes(std::int32_t* p, std::int32_t v) { *p = v; }
inline void store_lanes(std::uint32_t* p, std::uint32_t v) { *p = v; }
template <class T, class A>
void store_lanes(T* p, const xsimd::batch<T, A>& v) {
  v.store_aligned(p);
}
template <class V, class T>
V load_lanes(const T* p) {
  if constexpr (std::is_arithmetic_v<V>)
    return *p;
  else
    return V::load_aligned(p);
}

/// base[index] for each lane.
inline float gather(const float* base, std::int32_t index) { return base[index]; }
inline std::int32_t gather(const std::int32_t* base, std::int32_t index) { return base[index]; }
inline std::uint32_t gather(const std::uint32_t* base, std::int32_t index) { return base[index]; }
/// By the instruction where there is one: xsimd 8's own gather goes through memory, lane by lane, even on AVX-512.
template <class T, class A>
xsimd::batch<T, A> gather(const T* base, const xsimd::batch<std::int32_t, A>& index) {
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<T, float>)
    return xsimd::batch<T, A>(_mm512_i32gather_ps(index.data, base, 4));
  else
    return xsimd::batch<T, A>(_mm512_i32gather_epi32(index.data, base, 4));
#elif defined(__AVX2__)
  if constexpr (std::is_same_v<T, float>)
    return xsimd::batch<T, A>(_mm256_i32gather_ps(base, index.data, 4));
  else
    return xsimd::batch<T, A>(_mm256_i32gather_epi32(reinterpret_cast<const int*>(base), index.data, 4));
#else
  return xsimd::batch<T, A>::gather(base, index);
#endif
}

// --- masks ---

inline float select(bool m, float a, float b) { return m ? a : b; }
inline std::int32_t select(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
template <class A>
xsimd::batch<float, A> select(const xsimd::batch_bool<float, A>& m, const xsimd::batch<float, A>& a,
                              const xsimd::batch<float, A>& b) {
  return xsimd::select(m, a, b);
}
template <class A>
xsimd::batch<std::int32_t, A> select(const xsimd::batch_bool<float, A>& m, const xsimd::batch<std::int32_t, A>& a,
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
xsimd::batch_bool<float, A> mask_and(const xsimd::batch_bool<float, A>& a, const xsimd::batch_bool<float, A>& b) {
  return a & b;
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
xsimd::batch_bool<float, A> equal(const xsimd::batch<std::int32_t, A>& a, const xsimd::batch<std::int32_t, A>& b) {
  return lanes::mask_for_floats(a == b);
}
inline bool less(std::int32_t a, std::int32_t b) { return a < b; }
template <class A>
xsimd::batch_bool<float, A> less(const xsimd::batch<std::int32_t, A>& a, const xsimd::batch<std::int32_t, A>& b) {
  return lanes::mask_for_floats(a < b);
}
inline bool less(std::uint32_t a, std::uint32_t b) { return a < b; }
/// Unsigned: both are shifted into the signed range, because SSE and AVX2 compare signed only.
template <class A>
xsimd::batch_bool<float, A> less(const xsimd::batch<std::uint32_t, A>& a, const xsimd::batch<std::uint32_t, A>& b) {
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

// Lanes: one float, or a batch of floats, behind the same names; how they meet memory. The only file to
// include xsimd.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

// GCC 12 takes what its AVX-512 header leaves undefined on purpose (_mm512_undefined_ps) for a mistake of
// ours.
#if defined(__AVX512F__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#endif
#include <xsimd/xsimd.hpp>

namespace etendue {

/// Lanes of the widest batch that any kernel is built for.
inline constexpr int widest_lanes = 16;

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

inline std::int32_t first_lane(std::int32_t v) { return v; }
template <class A>
std::int32_t first_lane(const xsimd::batch<std::int32_t, A>& v) {
  return v.get(0);
}

}  // namespace etendue

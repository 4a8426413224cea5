// Lanes: one float, or a batch of floats, behind the same names; how they meet memory. The only file to include xsimd.
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

/// The bits of every lane in the opposite order.
inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}
/// By two table look-ups a byte (one for each half) and a shuffle of bytes, where the instruction set has it.
template <class A>
xsimd::batch<std::uint32_t, A> reverse_bits(const xsimd::batch<std::uint32_t, A>& x) {
  using U = xsimd::batch<std::uint32_t, A>;
  const U low_half(0x0f0f0f0fu);
  [[maybe_unused]] const U low = x & low_half, high = (x >> 4) & low_half;
#if defined(__SSSE3__)
  const __m128i reversed_in_high = _mm_setr_epi8(0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80, 112, -16);
  const __m128i reversed_in_low = _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
  const __m128i bytes_reversed = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
#if defined(__AVX512BW__)
  const __m512i bytes = _mm512_or_si512(_mm512_shuffle_epi8(_mm512_broadcast_i32x4(reversed_in_high), low.data),
                                        _mm512_shuffle_epi8(_mm512_broadcast_i32x4(reversed_in_low), high.data));
  return U(_mm512_shuffle_epi8(bytes, _mm512_broadcast_i32x4(bytes_reversed)));
#elif defined(__AVX2__)
  const __m256i bytes = _mm256_or_si256(_mm256_shuffle_epi8(_mm256_broadcastsi128_si256(reversed_in_high), low.data),
                                        _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(reversed_in_low), high.data));
  return U(_mm256_shuffle_epi8(bytes, _mm256_broadcastsi128_si256(bytes_reversed)));
#else
  const __m128i bytes =
      _mm_or_si128(_mm_shuffle_epi8(reversed_in_high, low.data), _mm_shuffle_epi8(reversed_in_low, high.data));
  return U(_mm_shuffle_epi8(bytes, bytes_reversed));
#endif
#else
#error "batches are built for x86-64-v2 and up"
#endif
}

}  // namespace etendue

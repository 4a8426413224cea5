// What lanes read from memory, each at an index of its own.
#pragma once

#include "base/simd.h"

#include <array>
#include <type_traits>

namespace etendue {

/// base[index] for each lane.
inline float gather(const float* base, std::int32_t index) { return base[index]; }
inline std::int32_t gather(const std::int32_t* base, std::int32_t index) { return base[index]; }
inline std::uint32_t gather(const std::uint32_t* base, std::int32_t index) { return base[index]; }
/// By the instruction where there is one: xsimd 8's own gather goes through memory, lane by lane, even on
/// AVX-512.
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

/// base[index] .. base[index + 3] for each lane.
inline std::array<float, 4> gather_four(const float* base, std::int32_t index) {
  return {base[index], base[index + 1], base[index + 2], base[index + 3]};
}
/// By a load a lane and a transposition, a third of the time of four gathers: these take a load a number.
template <class A>
std::array<xsimd::batch<float, A>, 4> gather_four(const float* base,
                                                  const xsimd::batch<std::int32_t, A>& index) {
  using F = xsimd::batch<float, A>;
#if defined(__AVX512F__)
  alignas(64) std::int32_t at[16];
  index.store_aligned(at);
  // Lanes k, k + 4, k + 8, k + 12, so that what is left to do stays within quarters of the registers.
  const auto four_lanes = [&](int k) {
    __m512 r = _mm512_castps128_ps512(_mm_loadu_ps(base + at[k]));
    r = _mm512_insertf32x4(r, _mm_loadu_ps(base + at[k + 4]), 1);
    r = _mm512_insertf32x4(r, _mm_loadu_ps(base + at[k + 8]), 2);
    return _mm512_castps_pd(_mm512_insertf32x4(r, _mm_loadu_ps(base + at[k + 12]), 3));
  };
  const auto low = [](__m512d a, __m512d b) {
    return _mm512_castps_pd(_mm512_unpacklo_ps(_mm512_castpd_ps(a), _mm512_castpd_ps(b)));
  };
  const auto high = [](__m512d a, __m512d b) {
    return _mm512_castps_pd(_mm512_unpackhi_ps(_mm512_castpd_ps(a), _mm512_castpd_ps(b)));
  };
  const __m512d r0 = four_lanes(0), r1 = four_lanes(1), r2 = four_lanes(2), r3 = four_lanes(3);
  const __m512d xy_01 = low(r0, r1), zw_01 = high(r0, r1), xy_23 = low(r2, r3), zw_23 = high(r2, r3);
  return {F(_mm512_castpd_ps(_mm512_unpacklo_pd(xy_01, xy_23))),
          F(_mm512_castpd_ps(_mm512_unpackhi_pd(xy_01, xy_23))),
          F(_mm512_castpd_ps(_mm512_unpacklo_pd(zw_01, zw_23))),
          F(_mm512_castpd_ps(_mm512_unpackhi_pd(zw_01, zw_23)))};
#elif defined(__AVX2__)
  alignas(32) std::int32_t at[8];
  index.store_aligned(at);
  const auto two_lanes = [&](int k) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(base + at[k])),
                                _mm_loadu_ps(base + at[k + 4]), 1);
  };
  const __m256 r0 = two_lanes(0), r1 = two_lanes(1), r2 = two_lanes(2), r3 = two_lanes(3);
  const __m256d xy_01 = _mm256_castps_pd(_mm256_unpacklo_ps(r0, r1)),
                zw_01 = _mm256_castps_pd(_mm256_unpackhi_ps(r0, r1)),
                xy_23 = _mm256_castps_pd(_mm256_unpacklo_ps(r2, r3)),
                zw_23 = _mm256_castps_pd(_mm256_unpackhi_ps(r2, r3));
  return {F(_mm256_castpd_ps(_mm256_unpacklo_pd(xy_01, xy_23))),
          F(_mm256_castpd_ps(_mm256_unpackhi_pd(xy_01, xy_23))),
          F(_mm256_castpd_ps(_mm256_unpacklo_pd(zw_01, zw_23))),
          F(_mm256_castpd_ps(_mm256_unpackhi_pd(zw_01, zw_23)))};
#else
  return {F(gather(base, index)), F(gather(base + 1, index)), F(gather(base + 2, index)),
          F(gather(base + 3, index))};
#endif
}

}  // namespace etendue

// Bit tricks over lanes.
#pragma once

#include "base/simd.h"

namespace etendue {

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
  const __m128i reversed_in_high =
      _mm_setr_epi8(0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80, 112, -16);
  const __m128i reversed_in_low = _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
  const __m128i bytes_reversed = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
#if defined(__AVX512BW__)
  const __m512i bytes =
      _mm512_or_si512(_mm512_shuffle_epi8(_mm512_broadcast_i32x4(reversed_in_high), low.data),
                      _mm512_shuffle_epi8(_mm512_broadcast_i32x4(reversed_in_low), high.data));
  return U(_mm512_shuffle_epi8(bytes, _mm512_broadcast_i32x4(bytes_reversed)));
#elif defined(__AVX2__)
  const __m256i bytes =
      _mm256_or_si256(_mm256_shuffle_epi8(_mm256_broadcastsi128_si256(reversed_in_high), low.data),
                      _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(reversed_in_low), high.data));
  return U(_mm256_shuffle_epi8(bytes, _mm256_broadcastsi128_si256(bytes_reversed)));
#else
  const __m128i bytes = _mm_or_si128(_mm_shuffle_epi8(reversed_in_high, low.data),
                                     _mm_shuffle_epi8(reversed_in_low, high.data));
  return U(_mm_shuffle_epi8(bytes, bytes_reversed));
#endif
#else
  alignas(16) std::uint32_t lanes[U::size];
  x.store_aligned(lanes);
  for (std::uint32_t& lane : lanes) lane = reverse_bits(lane);
  return U::load_aligned(lanes);
#endif
}

/// The high 32 bits of the 64-bit product.
inline std::uint32_t mul_hi(std::uint32_t a, std::uint32_t b) {
  return std::uint32_t((std::uint64_t(a) * b) >> 32);
}
/// By two widening products, of the even and of the odd lanes.
template <class A>
xsimd::batch<std::uint32_t, A> mul_hi(const xsimd::batch<std::uint32_t, A>& a,
                                      const xsimd::batch<std::uint32_t, A>& b) {
  using U = xsimd::batch<std::uint32_t, A>;
#if defined(__AVX512F__)
  const __m512i even = _mm512_srli_epi64(_mm512_mul_epu32(a.data, b.data), 32);
  const __m512i odd = _mm512_mul_epu32(_mm512_srli_epi64(a.data, 32), _mm512_srli_epi64(b.data, 32));
  return U(_mm512_mask_blend_epi32(0xaaaa, even, odd));
#elif defined(__AVX2__)
  const __m256i even = _mm256_srli_epi64(_mm256_mul_epu32(a.data, b.data), 32);
  const __m256i odd = _mm256_mul_epu32(_mm256_srli_epi64(a.data, 32), _mm256_srli_epi64(b.data, 32));
  return U(_mm256_blend_epi32(even, odd, 0xaa));
#else
  const __m128i even = _mm_srli_epi64(_mm_mul_epu32(a.data, b.data), 32);
  const __m128i odd = _mm_mul_epu32(_mm_srli_epi64(a.data, 32), _mm_srli_epi64(b.data, 32));
  return U(_mm_or_si128(even, _mm_and_si128(odd, _mm_set1_epi64x(std::int64_t(0xffffffff00000000u)))));
#endif
}

}  // namespace etendue

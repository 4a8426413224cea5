// Elementary functions over lanes, and loops over the distinct values in a packet.
#pragma once

#include "base/bits.h"
#include "base/mask.h"

namespace etendue {

// Found by overload for float (std) and by argument-dependent lookup for batches (xsimd).
using std::abs;
using std::floor;
using std::sqrt;
using xsimd::abs;
using xsimd::floor;
using xsimd::sqrt;

inline float min(float a, float b) { return a < b ? a : b; }
inline std::int32_t min(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline std::int32_t max(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
template <class A>
xsimd::batch<float, A> min(const xsimd::batch<float, A>& a, const xsimd::batch<float, A>& b) {
  return xsimd::min(a, b);
}
template <class A>
xsimd::batch<float, A> max(const xsimd::batch<float, A>& a, const xsimd::batch<float, A>& b) {
  return xsimd::max(a, b);
}

inline float exp(float x) { return std::exp(x); }
inline float log(float x) { return std::log(x); }
inline float expm1(float x) { return std::expm1(x); }
template <class A>
xsimd::batch<float, A> exp(const xsimd::batch<float, A>& x) {
  return xsimd::exp(x);
}
template <class A>
xsimd::batch<float, A> expm1(const xsimd::batch<float, A>& x) {
  return xsimd::expm1(x);
}
template <class A>
xsimd::batch<float, A> log(const xsimd::batch<float, A>& x) {
  return xsimd::log(x);
}

/// x^y for x >= 0; 0^y = 0, for y = 0 too: a lobe cos^0 ends where the cosine does.
inline float pow_positive(float x, float y) { return x > 0 ? std::pow(x, y) : 0; }
template <class A>
xsimd::batch<float, A> pow_positive(const xsimd::batch<float, A>& x, const xsimd::batch<float, A>& y) {
  using F = xsimd::batch<float, A>;
  return select(x > F(0), xsimd::exp(y * xsimd::log(x)), F(0));
}

/// The sine and cosine of 2 pi t, t in [0, 1).
inline void sincos_turns(float t, float& sine, float& cosine) {
  constexpr float two_pi = 6.28318530717958647692f;
  sine = std::sin(two_pi * t);
  cosine = std::cos(two_pi * t);
}
template <class A>
void sincos_turns(const xsimd::batch<float, A>& t, xsimd::batch<float, A>& sine,
                  xsimd::batch<float, A>& cosine) {
  constexpr float two_pi = 6.28318530717958647692f;
  const auto pair = xsimd::sincos(t * two_pi);
  sine = pair.first;
  cosine = pair.second;
}

/// The angle of (x, y) from the x axis, in [-pi, pi]; 0 for (0, 0).
inline float atan2(float y, float x) { return x == 0 && y == 0 ? 0 : std::atan2(y, x); }
template <class A>
xsimd::batch<float, A> atan2(const xsimd::batch<float, A>& y, const xsimd::batch<float, A>& x) {
  using F = xsimd::batch<float, A>;
  // xsimd's own gives NaN at the origin.
  const auto is_origin = mask_and(x == F(0), y == F(0));
  return select(is_origin, F(0), xsimd::atan2(y, select(is_origin, F(1), x)));
}

/// 32 random bits as a float in [0, 1): the upper 24 bits.
template <class U>
auto to_unit_float(const U& bits) {
  return to_float(as_int(bits >> 8)) * 0x1p-24f;
}

/// x >= 0 and finite; false for NaN.
template <class F>
Mask<F> is_finite_nonnegative(const F& x) {
  return mask_and(x >= F(0), x <= F(3.402823466e+38f));
}

/// f(value, lanes) for each distinct value among the lanes of `m`, in order of first appearance.
template <class F, class Function>
void for_each_unique(const Int<F>& value, Mask<F> m, Function&& f) {
  if constexpr (lane_count_v<F> == 1) {
    if (m) f(value, m);
  } else {
    if (!any(m)) return;
    alignas(64) std::int32_t values[lane_count_v<F>], is_left[lane_count_v<F>];
    store_lanes(values, value);
    store_mask<F>(is_left, m);
    for (int lane = 0; lane < lane_count_v<F>; ++lane) {
      if (!is_left[lane]) continue;
      const Mask<F> same = mask_and(m, equal(value, Int<F>(values[lane])));
      f(values[lane], same);
      m = mask_and(m, mask_not(same));
      if (!any(m)) return;
      store_mask<F>(is_left, m);
    }
  }
}

}  // namespace etendue

// Vectors and colours over lanes: chosen between, looked up.
#pragma once

#include "base/color.h"
#include "base/gather.h"
#include "base/mask.h"
#include "base/vec.h"

namespace etendue {

template <class F>
Vec3<F> select(const Mask<F>& m, const Vec3<F>& a, const Vec3<F>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

template <class F>
Color<F> select(const Mask<F>& m, const Color<F>& a, const Color<F>& b) {
  return {select(m, a.r, b.r), select(m, a.g, b.g), select(m, a.b, b.b)};
}

/// Lanes of three floats that lie one after the other: first[at], first[at + 1], first[at + 2].
template <class F>
Vec3<F> gather_vec3(const float* first, const Int<F>& at) {
  return {gather(first, at), gather(first + 1, at), gather(first + 2, at)};
}

template <class F>
Color<F> black() {
  return {F(0), F(0), F(0)};
}

/// False for NaN: what is not a number is not nothing.
template <class F>
Mask<F> is_black(const Color<F>& c) {
  return mask_and(c.r == F(0), c.g == F(0), c.b == F(0));
}

}  // namespace etendue

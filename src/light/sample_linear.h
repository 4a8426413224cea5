// Places in [0, 1) along a line.
#pragma once

#include "base/mask.h"
#include "base/simd_math.h"

namespace etendue {

/// A place in [0, 1) with density in proportion to the line from `a` to `b`, both >= 0 (Shirley, Laine, Hart,
/// Pharr, Clarberg, Haines, Raab and Cline 2019, "Sampling transformations zoo", in Ray Tracing Gems).
template <class F>
F sample_linear(const F& u, const F& a, const F& b) {
  const F sum = a + b;
  const F begin = select(sum > F(0), a / sum, F(0.5f)), end = select(sum > F(0), b / sum, F(0.5f));
  const F root = sqrt(max(begin * begin + u * (end * end - begin * begin), F(0)));
  return min(u / max(begin + root, F(1e-30f)), F(0x1.fffffep-1f));
}

}  // namespace etendue

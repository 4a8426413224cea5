// An orthonormal frame around a unit normal.
#pragma once

#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

/// Local z is the normal. Duff et al. 2017, "Building an orthonormal basis, revisited".
template <class F>
struct Frame {
  Vec3<F> s, t, n;

  explicit Frame(const Vec3<F>& normal) : n(normal) {
    const F sign = select(n.z >= F(0), F(1), F(-1));
    const F a = F(-1) / (sign + n.z);
    const F b = n.x * n.y * a;
    s = {F(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3<F> local_from_world(const Vec3<F>& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3<F> world_from_local(const Vec3<F>& v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace etendue

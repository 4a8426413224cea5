// A ray and what it hits, over any lane type.
#pragma once

#include "base/simd_math.h"
#include "base/vec.h"

namespace etendue {

template <class F>
struct Ray {
  Vec3<F> origin;     ///< World, m.
  Vec3<F> direction;  ///< Unit, but of segments, whose t runs from 0 to 1.
};

template <class F>
struct Hit {
  F t;                  ///< Along the ray, m.
  Vec2<F> barycentric;  ///< Of vertices 1 and 2; on a disk its own coordinates.
  Vec3<F> ng;           ///< Geometric normal, not normalised.
  Int<F> geometry;      ///< Its id; -1: the ray left the scene.
  Int<F> primitive;     ///< The triangle within a mesh; 0 of other shapes.
};

}  // namespace etendue

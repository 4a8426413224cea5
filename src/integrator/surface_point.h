// The surface under a packet of samples, and where rays that leave it start and end.
#pragma once

#include "integrator/sample_block.h"

namespace etendue {

/// A shadow segment ends this far along its way to the light, so that the light does not shadow itself.
inline constexpr float shadow_segment_end = 1 - 1e-4f;

/// Rays start this far off the surface, as a fraction of the largest coordinate or of the distance from the camera,
/// whichever is larger: some tens of rounding errors of the hit point.
inline constexpr float ray_offset = 1e-5f;

/// How far off the surface the rays that leave it start (m), for a point found at `distance` along its ray.
template <class F>
F ray_clearance(const Vec3<F>& position, const F& distance) {
  return F(ray_offset) * max(max(abs(position.x), abs(position.y)), max(abs(position.z), distance));
}

template <class F>
struct SurfacePoint {
  Vec3<F> position, ng, ns, wo;
  F clearance;
  Int<F> material;
  Mask<F> is_there;

  SurfacePoint(const SampleBlock& block, int i)
      : position(load_lanes<F>(block.position, i)),
        ng(load_lanes<F>(block.ng, i)),
        ns(load_lanes<F>(block.ns, i)),
        wo(load_lanes<F>(block.wo, i)),
        clearance(load_lanes<F>(&block.clearance[i])),
        material(load_lanes<Int<F>>(&block.material[i])),
        is_there(less(Int<F>(-1), material)) {}

  /// Whether wo and wi lie on one side of the surface itself, not only of its shading normal.
  Mask<F> reflects_towards(const Vec3<F>& wi) const { return dot(ng, wo) * dot(ng, wi) > F(0); }

  /// Where a reflected ray starts.
  Vec3<F> offset_origin() const { return position + ng * select(dot(ng, wo) > F(0), clearance, -clearance); }
};

}  // namespace etendue

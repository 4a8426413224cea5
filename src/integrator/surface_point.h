// The surface under a packet of samples, and where rays that leave it start and end.
#pragma once

#include "integrator/sample_block.h"
#include "scene/scene.h"

namespace etendue {

/// A shadow segment ends this far along its way to the light, so that the light does not shadow itself.
inline constexpr float shadow_segment_end = 1 - 1e-4f;

/// Rays start this far off the surface, as a fraction of the largest coordinate or of the distance from the
/// camera, whichever is larger: some tens of rounding errors of the hit point.
inline constexpr float ray_offset = 1e-5f;

/// How far off the surface the rays that leave it start (m), for a point found at `distance` along its ray.
template <class F>
F ray_clearance(const Vec3<F>& position, const F& distance) {
  return F(ray_offset) * max(max(abs(position.x), abs(position.y)), max(abs(position.z), distance));
}

/// A hit's normals, in the lanes of `is_hit`.
template <class F>
struct HitNormals {
  Vec3<F> ng;  ///< Unit.
  Vec3<F> ns;  ///< Unit; ng where the shape has no vertex normals.

  HitNormals(const Scene& scene, const HitColumns& hits, int i, const Mask<F>& is_hit)
      : ng(normalize(load_lanes<F>(hits.ng, i))), ns(ng) {
    if (!scene.geometry.has_any_normals) return;
    const Int<F> geometry = select(is_hit, load_lanes<Int<F>>(&hits.geometry[i]), Int<F>(0));
    const Mask<F> is_smooth =
        mask_and(is_hit, equal(gather(scene.geometry.has_normals.data(), geometry), Int<F>(1)));
    if (!any(is_smooth)) return;
    const Vec2<F> barycentric{load_lanes<F>(&hits.u[i]), load_lanes<F>(&hits.v[i])};
    const Vec3<F> smooth = normalize(interpolate_normal<F>(
        scene.geometry, geometry, load_lanes<Int<F>>(&hits.primitive[i]), barycentric, is_smooth));
    ns = select(is_smooth, smooth, ng);
  }
};

/// What the rays i, i + 1 ... have hit.
template <class F>
struct SurfacePoint {
  Mask<F> is_there;
  Vec3<F> position, ng, ns, wo;
  F clearance;
  Int<F> material;  ///< Any where nothing is there.

  SurfacePoint(const Scene& scene, const RayColumns& rays, const HitColumns& hits, int i) {
    const Int<F> geometry = load_lanes<Int<F>>(&hits.geometry[i]);
    is_there = less(Int<F>(-1), geometry);
    const HitNormals<F> normals(scene, hits, i, is_there);
    const F t = load_lanes<F>(&hits.t[i]);
    const Vec3<F> direction = load_lanes<F>(rays.direction, i);
    position = load_lanes<F>(rays.origin, i) + direction * t;
    ng = normals.ng;
    ns = normals.ns;
    wo = -direction;
    clearance = ray_clearance(position, t);
    material = gather(scene.geometry.material.data(), select(is_there, geometry, Int<F>(0)));
  }

  /// Whether wo and wi lie on one side of the surface itself, not only of its shading normal.
  Mask<F> reflects_towards(const Vec3<F>& wi) const { return dot(ng, wo) * dot(ng, wi) > F(0); }

  /// Where a reflected ray starts.
  Vec3<F> offset_origin() const { return position + ng * select(dot(ng, wo) > F(0), clearance, -clearance); }
};

}  // namespace etendue

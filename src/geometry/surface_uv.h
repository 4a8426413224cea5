// Surface coordinates of a hit, where textures are looked up.
#pragma once

#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/geometry.h"

namespace etendue {

/// The angle of (x, y) from the x axis as a fraction of a turn, [0, 1]; 0 at the origin.
template <class F>
F turns_of(const F& x, const F& y) {
  const Mask<F> is_origin = mask_and(x == F(0), y == F(0));
  const F turns = atan2(y, select(is_origin, F(1), x)) * F(0.5f * inv_pi);
  return select(turns < F(0), turns + F(1), turns);
}

/// u: the angle around z from the x axis; v: the angle from +z; both over their range, [0, 1]. This is Nori's
/// sphericalCoordinates(); the numbers of Tuebingen's test of its checkerboard ask for it. ETH's u begins
/// half a turn further on. \param ng the sphere's outward normal, unit, in the world \param u_offset added to
/// u, modulo 1; in [0, 1)
template <class F>
Vec2<F> sphere_uv(const Vec3<F>& ng, const F& u_offset) {
  const F u = turns_of(ng.x, ng.y) + u_offset;
  return {select(u > F(1), u - F(1), u), atan2(sqrt(ng.x * ng.x + ng.y * ng.y), ng.z) * F(inv_pi)};
}

/// u: the distance from the centre, 1 at the edge; v: the angle from the x axis over 2 pi, as in Mitsuba.
/// \param on_disk what the ray caster gives: the point of the unit disk
template <class F>
Vec2<F> disk_uv(const Vec2<F>& on_disk) {
  return {sqrt(on_disk.x * on_disk.x + on_disk.y * on_disk.y), turns_of(on_disk.x, on_disk.y)};
}

/// Surface coordinates of a hit in the lanes of `m`: of a mesh interpolated at barycentric (u, v) of its
/// triangle, and these themselves where it has none, as in Nori; else by the functions above.
template <class F>
Vec2<F> surface_uv(const Geometry& geometry, const Int<F>& geometry_id, const Int<F>& primitive,
                   const Vec2<F>& barycentric, const Vec3<F>& ng, const Mask<F>& m) {
  const Int<F> zero(0);
  const Int<F> safe_id = select(m, geometry_id, zero);
  const Mask<F> is_mesh = mask_and(m, less(zero, gather(geometry.triangles.data(), safe_id)));
  const Mask<F> is_sphere = mask_and(m, less(Int<F>(-1), gather(geometry.sphere.data(), safe_id)));
  const Mask<F> is_disk = mask_and(m, less(Int<F>(-1), gather(geometry.disk.data(), safe_id)));
  Vec2<F> uv{F(0), F(0)};
  const auto choose = [&](const Mask<F>& lanes, const Vec2<F>& value) {
    uv = {select(lanes, value.x, uv.x), select(lanes, value.y, uv.y)};
  };
  if (any(is_sphere)) choose(is_sphere, sphere_uv(ng, gather(geometry.u_offset.data(), safe_id)));
  if (any(is_disk)) choose(is_disk, disk_uv(barycentric));
  if (!any(is_mesh)) return uv;
  const Mask<F> has_uvs = mask_and(is_mesh, equal(gather(geometry.has_uvs.data(), safe_id), Int<F>(1)));
  choose(is_mesh, barycentric);
  if (!any(has_uvs)) return uv;
  const Int<F> triangle = select(has_uvs, gather(geometry.first_triangle.data(), safe_id) + primitive, zero);
  const float* uvs = &geometry.uvs[0].x;
  const auto corner_uv = [&](int corner) {
    const Int<F> at = gather(geometry.indices.data() + corner, triangle * Int<F>(3)) * Int<F>(2);
    return Vec2<F>{gather(uvs, at), gather(uvs + 1, at)};
  };
  const Vec2<F> uv_0 = corner_uv(0), uv_1 = corner_uv(1), uv_2 = corner_uv(2);
  const F w = F(1) - barycentric.x - barycentric.y;
  choose(has_uvs, {uv_0.x * w + uv_1.x * barycentric.x + uv_2.x * barycentric.y,
                   uv_0.y * w + uv_1.y * barycentric.x + uv_2.y * barycentric.y});
  return uv;
}

}  // namespace etendue

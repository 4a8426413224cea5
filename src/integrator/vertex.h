// A vertex of a packet of paths: the surface or the place in a medium that their rays have come to, and where
// rays that leave it start and end.
#pragma once

#include "bsdf/bsdf.h"
#include "geometry/clearance.h"
#include "geometry/ray.h"
#include "geometry/surface_uv.h"
#include "light/receiver.h"
#include "scene/scene.h"

namespace etendue {

/// A shadow segment ends this far along its way: short of its end by the rounding of its direction. The end
/// itself lies off the light's surface (LightSample::end).
inline constexpr float shadow_segment_end = 1 - rounding_bound;

/// The `geometry` of a hit where the path has scattered in the medium, at t; -1: the ray left the scene.
inline constexpr std::int32_t in_medium = -2;

/// A hit's normals, in the lanes of `is_hit`.
template <class F>
struct HitNormals {
  Vec3<F> ng;  ///< Unit.
  Vec3<F> ns;  ///< Unit; ng where the shape has no vertex normals, or those around the place cancel.

  HitNormals(const Scene& scene, const Hit<F>& hit, const Mask<F>& is_hit) : ng(normalize(hit.ng)), ns(ng) {
    if (!scene.geometry.has_any_normals) return;
    const Int<F> geometry = select(is_hit, hit.geometry, Int<F>(0));
    const Mask<F> is_smooth =
        mask_and(is_hit, equal(gather(scene.geometry.has_normals.data(), geometry), Int<F>(1)));
    if (!any(is_smooth)) return;
    const Vec3<F> smooth =
        interpolate_normal<F>(scene.geometry, geometry, hit.primitive, hit.barycentric, is_smooth);
    const F size_sq = dot(smooth, smooth);
    constexpr float cancelled = 1e-12f;
    ns = select(mask_and(is_smooth, mask_not(size_sq <= F(cancelled))), smooth * (F(1) / sqrt(size_sq)), ng);
  }
};

/// What a packet of rays has come to.
template <class F>
struct Vertex {
  Mask<F> is_there;    ///< Elsewhere the ray left the scene.
  Mask<F> is_surface;  ///< Elsewhere, where anything is there, the path scatters in the medium.
  /// Off the surface, towards wo, by what rounding cannot tell from it: rays on that side start here.
  Vec3<F> position;
  Vec3<F> wo;
  Vec3<F> ng, ns;   ///< In the medium both are wo.
  Vec2<F> uv;       ///< Zero unless the scene has textures.
  Vec3<F> across;   ///< From `position` through the surface, to where rays on its other side start.
  Int<F> material;  ///< Any where no surface is.

  Vertex(const Scene& scene, const Ray<F>& ray, const Hit<F>& hit) {
    is_surface = less(Int<F>(-1), hit.geometry);
    is_there = is_surface;
    const HitNormals<F> normals(scene, hit, is_surface);
    const Vec3<F> along = ray.direction * hit.t, point = ray.origin + along;
    wo = -ray.direction;
    ng = normals.ng;
    ns = normals.ns;
    const Int<F> safe = select(is_surface, hit.geometry, Int<F>(0));
    F height =
        clearance<F>(ng, abs_each(point) + abs_each(along), gather(scene.geometry.longest_edge.data(), safe));
    material = gather(scene.geometry.material.data(), safe);
    uv = {F(0), F(0)};
    if (scene.materials.have_textures())
      uv = surface_uv<F>(scene.geometry, safe, hit.primitive, hit.barycentric, ng, is_surface);
    if (scene.medium) {
      const Mask<F> is_in_medium = equal(hit.geometry, Int<F>(in_medium));
      is_there = mask_not(equal(hit.geometry, Int<F>(-1)));
      ng = select(is_in_medium, wo, ng);
      ns = select(is_in_medium, wo, ns);
      height = select(is_in_medium, F(0), height);
    }
    const Vec3<F> off = ng * select(dot(ng, wo) > F(0), height, -height);
    position = point + off;
    across = off * F(-2);
  }

  /// What lights see of the vertex.
  Receiver<F> receiver(const Scene& scene) const {
    const Int<F> sides = scene.materials.lit_sides<F>(material), both(lit_side::front | lit_side::back);
    const Mask<F> is_seen = mask_or(dot(wo, ns) > F(0), equal(sides, both));
    const Int<F> seen_sides = select(is_seen, sides, Int<F>(lit_side::none));
    Receiver<F> receiver{position, ng, ns, select(is_surface, seen_sides, Int<F>(lit_side::medium))};
    if (scene.materials.lobes().have_any()) {
      receiver.lobes = &scene.materials.lobes();
      receiver.material = material;
      receiver.wo = wo;
    }
    return receiver;
  }

  /// Where BSDF samples find nothing that light samples do not find better: on diffuse surfaces.
  Mask<F> leaves_direct_light_to_lights(const Scene& scene) const {
    return mask_and(is_surface, scene.materials.is_diffuse<F>(material));
  }

  /// Whether a direction lies on the side of the surface itself that it has relative to the shading normal,
  /// both measured from the side of wo; without that, light leaks through smooth meshes.
  Mask<F> is_consistent(const F& cos_theta_o, const F& cos_theta_i, const Vec3<F>& wi) const {
    return mask_or(cos_theta_o * cos_theta_i * (dot(ng, wo) * dot(ng, wi)) > F(0), mask_not(is_surface));
  }

  /// |cos theta_i| at a surface, 1 in the medium.
  F foreshortening(const F& cos_theta_i) const { return select(is_surface, abs(cos_theta_i), F(1)); }

  /// Where a ray along `wi` starts.
  Vec3<F> origin_of_ray(const Vec3<F>& wi) const {
    return select(dot(across, wi) > F(0), position + across, position);
  }
};

/// f(model, lanes) for each distinct material, and for the medium's phase function, among the lanes of `m`.
template <class F, class Function>
void for_each_scatterer(const Scene& scene, const Vertex<F>& vertex, const Mask<F>& m, Function&& f) {
  for_each_material<F>(scene.materials, vertex.material, vertex.uv, mask_and(m, vertex.is_surface), f);
  if (!scene.medium) return;
  const Mask<F> is_in_medium = mask_and(m, mask_not(vertex.is_surface));
  if (any(is_in_medium)) f(scene.medium->phase, is_in_medium);
}

}  // namespace etendue

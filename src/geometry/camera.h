// The perspective camera: a film position -> a ray.
#pragma once

#include "base/simd_math.h"
#include "base/transform.h"
#include "base/vec.h"
#include "geometry/geometry.h"
#include "scenefile/parameters.h"
#include "scenefile/scene_desc.h"

namespace etendue {

template <class F>
struct CameraRay {
  Vec3<F> origin, direction;  ///< The direction is unit.
  F t_near, t_far;            ///< The clip planes, as distances along this ray (m).
};

/// A pinhole or a thin lens. The field of view is horizontal, as in the Nori family.
struct Camera {
  int width_px = 1280, height_px = 720;
  Vec3<double> origin{0, 0, 0};  ///< m
  /// Direction = at_film_origin + x * per_px_x + y * per_px_y for film coordinates in pixels from the upper
  /// left; its component along the optical axis is 1.
  Vec3<double> at_film_origin{}, per_px_x{}, per_px_y{};
  float near_clip = 1e-4f, far_clip = 1e4f;  ///< Along the optical axis from where rays start, in the
                                             ///< camera's own units.
  /// Where rays start: start + x * start_per_px_x + y * start_per_px_y, in the plane square to the optical
  /// axis at start_depth (in those units) before the camera. At 0, where approach() does not set it, in the
  /// lens.
  Vec3f start{0, 0, 0}, start_per_px_x{0, 0, 0}, start_per_px_y{0, 0, 0};
  float start_depth = 0;
  /// The lens lies around `origin`, square to the optical axis: its radii along the camera's x and y, in the
  /// world (m).
  Vec3f lens_x{0, 0, 0}, lens_y{0, 0, 0};
  float inv_focus_distance = 0;  ///< Of the plane that is sharp, along the optical axis (1/m).
  bool has_lens = false;         ///< Otherwise it is a pinhole.

  /// The ray through the middle of the lens.
  template <class F>
  CameraRay<F> ray(const F& x_px, const F& y_px) const {
    return ray_from(start_of(x_px, y_px), along(x_px, y_px));
  }

  /// The ray through a point of the lens, which meets the one through its middle in the plane that is sharp.
  /// \param on_lens in the unit disk
  template <class F>
  CameraRay<F> ray(const F& x_px, const F& y_px, const Vec2<F>& on_lens) const {
    const Vec3<F> from_middle{F(lens_x.x) * on_lens.x + F(lens_y.x) * on_lens.y,
                              F(lens_x.y) * on_lens.x + F(lens_y.y) * on_lens.y,
                              F(lens_x.z) * on_lens.x + F(lens_y.z) * on_lens.y};
    return ray_from(start_of(x_px, y_px) + from_middle * F(1 - start_depth * inv_focus_distance),
                    along(x_px, y_px) - from_middle * F(inv_focus_distance));
  }

  /// Lets the rays of a camera that is far from all there is to see start close before it, at their places in
  /// double precision: from where the camera is, floats tell neither the distances of what is there nor its
  /// directions well enough. Changes nothing within three radii of the scene's middle.
  /// \param scene around all that rays can meet
  void approach(const Sphere& scene);

  Vec3f eye() const { return narrow(origin); }

 private:
  template <class F>
  static Vec3<F> on_film(const Vec3f& at_origin, const Vec3f& per_px_x, const Vec3f& per_px_y, const F& x_px,
                         const F& y_px) {
    return {F(at_origin.x) + x_px * F(per_px_x.x) + y_px * F(per_px_y.x),
            F(at_origin.y) + x_px * F(per_px_x.y) + y_px * F(per_px_y.y),
            F(at_origin.z) + x_px * F(per_px_x.z) + y_px * F(per_px_y.z)};
  }
  template <class F>
  Vec3<F> start_of(const F& x_px, const F& y_px) const {
    return on_film(start, start_per_px_x, start_per_px_y, x_px, y_px);
  }
  template <class F>
  Vec3<F> along(const F& x_px, const F& y_px) const {
    return on_film(narrow(at_film_origin), narrow(per_px_x), narrow(per_px_y), x_px, y_px);
  }
  /// \param along has component 1 along the optical axis
  template <class F>
  CameraRay<F> ray_from(const Vec3<F>& from, const Vec3<F>& along) const {
    const F per_unit_depth = sqrt(dot(along, along));
    return {from, along * (F(1) / per_unit_depth), per_unit_depth * F(near_clip),
            per_unit_depth * F(far_clip)};
  }
};

const std::vector<Plugin>& camera_plugins();

/// Throws InputError for values out of range and for a singular transform.
Camera make_camera(const Object& description, Dialect dialect, std::vector<UnreadKey>& unread);

}  // namespace etendue

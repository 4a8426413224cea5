// The perspective camera: a film position -> a ray.
#pragma once

#include "base/simd_math.h"
#include "base/transform.h"
#include "base/vec.h"
#include "scenefile/parameters.h"
#include "scenefile/scene_desc.h"

namespace etendue {

template <class F>
struct CameraRay {
  Vec3<F> origin, direction;  ///< The direction is unit.
  F t_near, t_far;            ///< The clip planes, as distances along this ray (m).
};

/// A pinhole camera. The field of view is horizontal, as in the Nori family.
struct Camera {
  int width_px = 1280, height_px = 720;
  Vec3f origin{0, 0, 0};  ///< m
  /// Direction = at_film_origin + x * per_px_x + y * per_px_y for film coordinates in pixels from the upper
  /// left; its component along the optical axis is 1.
  Vec3f at_film_origin{}, per_px_x{}, per_px_y{};
  float near_clip = 1e-4f, far_clip = 1e4f;  ///< Along the optical axis (m).

  template <class F>
  CameraRay<F> ray(const F& x_px, const F& y_px) const {
    const Vec3<F> along{F(at_film_origin.x) + x_px * F(per_px_x.x) + y_px * F(per_px_y.x),
                        F(at_film_origin.y) + x_px * F(per_px_x.y) + y_px * F(per_px_y.y),
                        F(at_film_origin.z) + x_px * F(per_px_x.z) + y_px * F(per_px_y.z)};
    const F per_unit_depth = sqrt(dot(along, along));
    return {{F(origin.x), F(origin.y), F(origin.z)},
            along * (F(1) / per_unit_depth),
            per_unit_depth * F(near_clip),
            per_unit_depth * F(far_clip)};
  }
};

const std::vector<Plugin>& camera_plugins();

/// Throws InputError for values out of range and for a singular transform.
Camera make_camera(const Object& description, Dialect dialect, std::vector<UnreadKey>& unread);

}  // namespace etendue

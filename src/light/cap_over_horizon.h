// A spherical cap, the directions in which a receiver sees a sphere, and the receiver's horizon.
#pragma once

#include "base/frame.h"
#include "base/lane_vec.h"

namespace etendue {

template <class F>
struct CapOverHorizon {
  Vec3<F> axis, zenith;      ///< Unit, world.
  Vec3<F> up, across;        ///< Unit: square to the axis, towards the zenith; square to both.
  F sin_radius, cos_radius;  ///< Of the cap's angular radius, below a right angle.
  F sin_height, cos_height;  ///< Of the axis over the horizon.

  CapOverHorizon(const Vec3<F>& to_center, const F& sin_radius_sq, const Vec3<F>& normal)
      : axis(to_center),
        zenith(normal),
        sin_radius(sqrt(sin_radius_sq)),
        cos_radius(sqrt(max(F(1) - sin_radius_sq, F(0)))),
        sin_height(dot(axis, zenith)) {
    const Vec3<F> level = axis - zenith * sin_height;
    const F level_sq = length_sq(level);
    cos_height = sqrt(level_sq);
    // Where the axis is the zenith any direction is level.
    const Vec3<F> along =
        select(level_sq > F(1e-12f), level * (F(1) / max(cos_height, F(1e-30f))), Frame<F>(zenith).s);
    up = zenith * cos_height - along * sin_height;
    across = cross(zenith, along);
  }
};

/// A direction by its parts along up, across and the axis.
template <class F>
struct CapDirection {
  F up, across, axis;
  F cos_theta;  ///< Its height over the horizon.
};

/// The direction above a point of the flat disk that a cap with this radius has for a rim.
/// \param up of the point, in the disk's radii \param inside 1 - r^2, r being the point's distance from the
/// middle in the disk's radii
template <class F>
CapDirection<F> direction_above(const CapOverHorizon<F>& cap, const F& sin_radius, const F& cos_radius,
                                const F& up, const F& inside) {
  const F flat = sin_radius * up, z = max(cos_radius * cap.sin_height + flat * cap.cos_height, F(0));
  const F bulge = sin_radius * sin_radius * max(inside, F(0)), height = sqrt(z * z + bulge);
  const F rise = bulge / max(z + height, F(1e-30f));  // height - z
  return {flat + rise * cap.cos_height, F(0), cos_radius + rise * cap.sin_height, height};
}

}  // namespace etendue

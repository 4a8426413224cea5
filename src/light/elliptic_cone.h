// The cone over a disk or an ellipse: its planes of symmetry.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"

namespace etendue {

/// A disk as a receiver sees it. Lengths in units of its longer half axis.
template <class F>
struct SeenDisk {
  F center_x, center_y;  ///< From the foot of the receiver, along the longer and the shorter axis.
  F height;              ///< Of the receiver above the disk's plane, > 0.
  F width_sq;            ///< Of the shorter half axis, 0 < width_sq <= 1.
};

/// Points are those of the unit disk that the disk's half axes span. The cone's axis meets the disk elsewhere
/// than in its centre; the map of the unit disk that brings it there is a Lorentz transformation, as it keeps
/// the cone over the disk. In the result nothing is a difference of nearly equal numbers: see
/// docs/light_sampling.md.
template <class F>
class EllipticCone {
 public:
  explicit EllipticCone(const SeenDisk<F>& disk) {
    const F x_sq = disk.center_x * disk.center_x, y_sq = disk.center_y * disk.center_y,
            height_sq = disk.height * disk.height, b_sq = disk.width_sq;
    s = confocal(disk, x_sq, y_sq, height_sq);
    // Parts of 1, by which all differences below are sums.
    const F inv_x = F(1) / (F(1) + s), inv_y = F(1) / (b_sq + s);
    const F part_x = x_sq * inv_x, part_y = y_sq * inv_y, part_z = height_sq / s;
    velocity_ = {-disk.center_x * inv_x, -disk.center_y * inv_y * sqrt(b_sq)};
    const F slowness = part_z + s * (part_x * inv_x + part_y * inv_y);  // 1 - velocity^2
    gamma_ = F(1) / sqrt(slowness);
    const F mix = gamma_ / (gamma_ + F(1));

    // The section of the cone across its axis, in the velocity's frame: a symmetric matrix.
    const F shift = velocity_.x * velocity_.x * velocity_.y * velocity_.y * mix * mix * (F(1) - b_sq);
    const F xx = part_z + part_y - shift, yy = b_sq * (part_z + part_x) + shift;
    const F speeds = velocity_.x * velocity_.x + b_sq * velocity_.y * velocity_.y;
    const F xy = velocity_.x * velocity_.y * (mix * mix * speeds - mix * (F(1) + b_sq) - s);
    const F half = F(0.5f) * (xx - yy), split = sqrt(half * half + xy * xy);
    long_sq = F(0.5f) * (xx + yy) + split;
    short_sq = b_sq * part_z / long_sq;
    // Half the angle whose cosine and sine are half and xy over split: the greater of both first.
    const F size = max(split, F(tiny)), cos_double = select(split > F(0), abs(half) / size, F(1));
    const F greater = sqrt(F(0.5f) + F(0.5f) * cos_double), lesser = abs(xy) / (F(2) * size * greater);
    const Mask<F> is_long_x = half >= F(0);
    cos_turn_ = select(is_long_x, greater, lesser);
    sin_turn_ = select(is_long_x, lesser, greater);
    sin_turn_ = select(xy < F(0), -sin_turn_, sin_turn_);
  }

  // Squares: of the distance from the receiver to the disk along the axis, and of the half axes of the cone's
  // section there.
  F s, long_sq, short_sq;

  /// From the unit disk that the section spans to that of the light, and back.
  Vec2<F> from_axis(const Vec2<F>& p) const {
    return moved({cos_turn_ * p.x - sin_turn_ * p.y, sin_turn_ * p.x + cos_turn_ * p.y}, velocity_);
  }
  Vec2<F> to_axis(const Vec2<F>& p) const {
    const Vec2<F> there = moved(p, {-velocity_.x, -velocity_.y});
    return {cos_turn_ * there.x + sin_turn_ * there.y, cos_turn_ * there.y - sin_turn_ * there.x};
  }

 private:
  static constexpr float tiny = 1e-30f;

  /// Velocities are added so.
  Vec2<F> moved(const Vec2<F>& p, const Vec2<F>& velocity) const {
    const F along = velocity.x * p.x + velocity.y * p.y;
    const F stretch = F(1) / gamma_, shift = F(1) + along * gamma_ / (gamma_ + F(1));
    const F scale = F(1) / max(F(1) + along, F(tiny));
    return {(p.x * stretch + velocity.x * shift) * scale, (p.y * stretch + velocity.y * shift) * scale};
  }

  /// The s > 0 with x^2 / (1 + s) + y^2 / (b^2 + s) + z^2 / s = 1: of the confocal ellipsoid through the
  /// receiver. Newton's method on 1 / the sum, which is all but straight, from below; a circle's is closed.
  static F confocal(const SeenDisk<F>& disk, const F& x_sq, const F& y_sq, const F& height_sq) {
    const auto of_circle = [&](const F& offset_sq, const F& radius_sq) {
      const F height_by_radius = F(2) * disk.height * sqrt(radius_sq);
      const F excess = offset_sq + height_sq - radius_sq, size = abs(excess),
              greater = max(size, height_by_radius), lesser = min(size, height_by_radius),
              ratio = lesser / max(greater, F(tiny));
      const F sum = F(0.5f) * (size + greater * sqrt(F(1) + ratio * ratio));
      return select(excess > F(0), sum, height_sq * radius_sq / max(sum, F(tiny)));
    };
    F s = max(of_circle(x_sq + y_sq, F(1)), max(of_circle(x_sq, F(1)), of_circle(y_sq, disk.width_sq)));
    constexpr int most_steps = 24;  // Of ellipses ten thousand times as long as wide.
    Mask<F> is_done = F(1) < F(0);
    for (int step = 0; step < most_steps; ++step) {
      const F inv_x = F(1) / (F(1) + s), inv_y = F(1) / (disk.width_sq + s), inv_z = F(1) / s;
      const F part_x = x_sq * inv_x, part_y = y_sq * inv_y, part_z = height_sq * inv_z;
      const F sum = part_x + part_y + part_z, excess = max(sum - F(1), F(0));
      const F next = s + sum * excess / (part_x * inv_x + part_y * inv_y + part_z * inv_z);
      s = select(is_done, s, next);
      constexpr float near = 1e-4f;  // Which the step has squared.
      is_done = mask_or(is_done, excess < F(near));
      if (all(is_done)) break;
    }
    return s;
  }

  Vec2<F> velocity_;  ///< Where on the unit disk the cone's axis is.
  F gamma_;           ///< 1 / sqrt(1 - velocity^2)
  F cos_turn_, sin_turn_;
};

}  // namespace etendue

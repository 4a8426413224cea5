// Part of a spherical triangle beside the zenith: its projected solid angle, and directions with density in
// proportion to the cosine.
#pragma once

#include "base/angles.h"
#include "base/lane_vec.h"

namespace etendue {

/// The part between the azimuths of one corner, the tip, and of the triangle's middle corner. Two sides bound
/// it, the low one and the high one; both are followed by the angle along the low one, from the tip.
///
/// A side bounds, together with the zenith, half its angle times the cosine of its plane (Lambert 1760); the
/// sector is the difference. Where that would be one of nearly equal numbers, what the sector holds at each
/// angle is integrated: 1 - 1 / (1 + w (2 z + w)), for a low side at height z of the unit sphere and a high
/// one above it by w (both before they are brought back to the sphere).
template <class F>
class ProjectedSector {
 public:
  /// \param tip from the receiver (m), with the zenith as z, z >= 0 \param to_middle from there to the middle
  /// corner \param rise from the long side up to the middle corner (m), < 0 where the long side is the high
  /// one \param turn the z of the cross product of tip and middle corner (m^2), >= 0
  ProjectedSector(const Vec3<F>& tip, const Vec3<F>& to_middle, const F& rise, const F& turn) {
    const F tip_length = length(tip);
    const Vec3<F> to_low{to_middle.x, to_middle.y, to_middle.z - max(rise, F(0))};
    const Vec3<F> to_high{to_middle.x, to_middle.y, to_middle.z - min(rise, F(0))};
    const F across_low = max(length(cross(tip, to_low)), F(tiny)),
            across_high = max(length(cross(tip, to_high)), F(tiny));
    const F inv_across_low = F(1) / across_low, stretch = tip_length * inv_across_low;
    tip_ = tip * (F(1) / tip_length);
    tangent_ = (to_low - tip_ * dot(tip_, to_low)) * stretch;
    rise_ = abs(rise) * stretch;
    cos_low_ = turn * inv_across_low;
    cos_high_ = turn / across_high;
    sine_by_sine_ = across_high * inv_across_low;
    angle_ = half_turn_angle(across_low, dot(tip, tip + to_low));
    constexpr float small = 0.03f;  // Where both ways of integrating are off by some 1e-5.
    is_small_ = mask_and(angle_ < F(small), rise_ * angle_ < F(small));
    const F high_angle = half_turn_angle(across_high, dot(tip, tip + to_high));
    area_ = max(F(0.5f) * (cos_low_ * angle_ - cos_high_ * high_angle), F(0));
    if (any(is_small_)) {
      const F held_at_half = at(F(0.5f)).held, held_at_end = at(F(1)).held;
      area_ = select(is_small_, area_by_parabola(F(1), held_at_half, held_at_end), area_);
    }
  }

  const F& area() const { return area_; }  ///< The projected solid angle (sr).

  /// A direction, unit. \param u_area the share of the area between the tip's azimuth and its own
  /// \param u_height 0: on the low side, 1: on the high one
  Vec3<F> sample(const F& u_area, const F& u_height) const {
    const Place there = at(share_of_angle(u_area));
    const F inside = u_height * there.held, across = sqrt(F(1) - inside);
    const Vec3<F> low = tip_ * there.cosine + tangent_ * there.sine;
    return normalize(
        Vec3<F>{low.x * across, low.y * across, sqrt(low.z * low.z + (F(1) - low.z * low.z) * inside)});
  }

 private:
  static constexpr float tiny = 1e-30f;

  struct Place {
    F sine, cosine;  ///< Of the angle from the tip.
    F held;          ///< Of the disk below the low side, what lies between both sides.
  };
  /// \param share of the angle
  Place at(const F& share) const {
    Place place;
    sincos_half_turn(share * angle_, place.sine, place.cosine);
    const F z = tip_.z * place.cosine + tangent_.z * place.sine, w = rise_ * place.sine;
    const F more = w * (F(2) * max(z, F(0)) + w);
    place.held = more / (F(1) + more);
    return place;
  }

  F area_by_parabola(const F& share, const F& held_at_half, const F& held_at_end) const {
    const F slope = F(4) * held_at_half - held_at_end, bend = F(2) * held_at_end - F(4) * held_at_half;
    return F(0.5f) * cos_low_ * angle_ * share * share * (F(0.5f) * slope + F(1.0f / 3) * bend * share);
  }
  F area_by_arcs(const F& share, const Place& there) const {
    const F high_angle =
        half_turn_angle(sine_by_sine_ * there.sine, there.cosine + rise_ * tip_.z * there.sine);
    return max(F(0.5f) * (cos_low_ * angle_ * share - cos_high_ * high_angle), F(0));
  }

  /// Before which a share u of the area lies: a guess from the middle, then Newton's method.
  F share_of_angle(const F& u) const {
    const Place middle = at(F(0.5f)), end = at(F(1));
    const auto area_up_to = [&](const F& share, const Place& there) {
      const F by_parabola = area_by_parabola(share, middle.held, end.held);
      return all(is_small_) ? by_parabola : select(is_small_, by_parabola, area_by_arcs(share, there));
    };
    const F inv_area = F(1) / max(area_, F(tiny)), density = F(0.5f) * cos_low_ * angle_ * inv_area;
    const F half = area_up_to(F(0.5f), middle) * inv_area;
    const F inv_at_half = F(1) / max(density * middle.held, F(tiny)),
            inv_at_end = F(1) / max(density * end.held, F(tiny));
    // Before the middle the area grows as between x^2 and x.
    const F root = sqrt(u / max(half, F(tiny))), growth = F(2) * half * inv_at_half;
    const F before = root * ((F(1) - growth) + (growth - F(0.5f)) * root);
    // Behind it a cubic with the right slopes.
    const F rest = F(1) - half, t = (u - half) / max(rest, F(tiny));
    const F behind =
        F(0.5f) + t * (rest * inv_at_half + t * (F(1.5f) - rest * (F(2) * inv_at_half + inv_at_end) +
                                                 t * (rest * (inv_at_half + inv_at_end) - F(1))));
    F share = max(min(select(u < half, min(before, F(0.5f)), max(behind, F(0.5f))), F(1)), F(0));
    constexpr int most_steps = 6;
    Mask<F> is_done = F(1) < F(0);  // Each lane by itself: what it gives must not depend on its neighbours.
    for (int step = 0; step < most_steps; ++step) {
      const Place there = at(share);
      const F excess = area_up_to(share, there) * inv_area - u;
      const F next = share - excess / max(density * there.held, F(tiny));
      const F inside =
          select(next < F(0), share * F(0.5f), select(next > F(1), (share + F(1)) * F(0.5f), next));
      share = select(is_done, share, inside);
      constexpr float near = 1e-3f;  // Which the step has squared.
      is_done = mask_or(is_done, abs(excess) < F(near));
      if (all(is_done)) break;
    }
    return share;
  }

  Vec3<F> tip_, tangent_;  ///< Unit: where the low side begins, and the way it goes there.
  F angle_;                ///< Of the low side.
  F rise_;                 ///< Of the high side above the low one, over the sine of the angle.
  F cos_low_, cos_high_;   ///< Of the planes of both sides.
  F sine_by_sine_;         ///< Of the angles along the high and the low side, over the azimuth's.
  F area_;
  Mask<F> is_small_;
};

}  // namespace etendue

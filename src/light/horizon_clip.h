// The part of a convex polygon above a receiver's horizon.
#pragma once

#include "base/frame.h"
#include "light/polygon_fan.h"

namespace etendue {

/// Its sides in their turn, in a frame with the normal of the horizon as z. Each begins where the one before
/// ends, but for what the horizon cuts off: from `cut_end`, where the outline goes below, to `cut_begin`,
/// where it comes up again; that way along the horizon is the last side. Lanes with fewer sides have some
/// without length.
template <class F>
struct HorizonClip {
  Vec3<F> first_corner;  ///< Of the whole polygon, from the receiver (m).
  // From the first corner (m).
  std::array<Vec3<F>, most_corners + 1> begin, end;
  Vec3<F> cut_begin, cut_end;
  Mask<F> is_cut;
  bool is_any_cut;
  int sides;

  HorizonClip(const PolygonFan<F>& fan, const Frame<F>& frame)
      : first_corner(frame.local_from_world(fan.apex)), sides(fan.most) {
    const Vec3<F> zero{F(0), F(0), F(0)};
    std::array<Vec3<F>, most_corners + 1> corner;
    std::array<F, most_corners + 1> z;
    corner[0] = corner[std::size_t(sides)] = zero;
    z[0] = z[std::size_t(sides)] = first_corner.z;
    F least = first_corner.z;
    for (int k = 1; k < sides; ++k) {
      const auto n = std::size_t(k);
      corner[n] = select(less(Int<F>(k), fan.corners), frame.local_from_world(fan.from_apex[n]), zero);
      z[n] = first_corner.z + corner[n].z;
      least = min(least, z[n]);
    }
    is_cut = least < F(0);
    is_any_cut = any(is_cut);
    cut_begin = cut_end = zero;
    if (!is_any_cut) {
      for (std::size_t k = 0; k < std::size_t(sides); ++k) begin[k] = corner[k], end[k] = corner[k + 1];
      return;
    }
    for (std::size_t k = 0; k < std::size_t(sides); ++k) {
      const Mask<F> begins_below = z[k] < F(0), ends_below = z[k + 1] < F(0);
      const F share = z[k] / select(z[k] == z[k + 1], F(1), z[k] - z[k + 1]);
      Vec3<F> crossing = corner[k] + (corner[k + 1] - corner[k]) * share;
      crossing.z = -first_corner.z;  // on the horizon to the last bit
      cut_begin = select(mask_and(begins_below, mask_not(ends_below)), crossing, cut_begin);
      cut_end = select(mask_and(ends_below, mask_not(begins_below)), crossing, cut_end);
    }
    for (std::size_t k = 0; k < std::size_t(sides); ++k) {
      const Mask<F> begins_below = z[k] < F(0), ends_below = z[k + 1] < F(0);
      end[k] = select(ends_below, cut_end, corner[k + 1]);
      begin[k] = select(begins_below, select(ends_below, cut_end, cut_begin), corner[k]);
    }
    begin[std::size_t(sides)] = cut_end;
    end[std::size_t(sides)] = cut_begin;
    ++sides;
  }
};

}  // namespace etendue

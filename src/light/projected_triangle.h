// Directions in a spherical triangle beside the zenith, with density in proportion to the cosine.
#pragma once

#include "light/projected_sector.h"

namespace etendue {

/// Its two sectors meet at the azimuth of its middle corner; the long side runs through both.
template <class F>
class ProjectedTriangle {
 public:
  /// \param a a corner, from the receiver; z is the zenith, which is not inside; none has z < 0
  /// \param b, c the other corners, from there \param height of the receiver above the triangle's plane
  ProjectedTriangle(const Vec3<F>& a, const Vec3<F>& b, const Vec3<F>& c, const F& height) {
    const Vec3<F> zero{F(0), F(0), F(0)}, b_to_c = c - b;
    const F turn_ab = turn(a, b), turn_bc = turn(a + b, b_to_c), turn_ca = -turn(a, c);
    // Seen from the zenith the long side turns the other way than both others. Where rounding hides that, it
    // is the side next to the zenith.
    const Mask<F> left_ab = turn_ab > F(0), left_bc = turn_bc > F(0), left_ca = turn_ca > F(0);
    const F size_ab = abs(turn_ab), size_bc = abs(turn_bc), size_ca = abs(turn_ca);
    const Mask<F> are_alike =
        mask_or(mask_and(left_ab, left_bc, left_ca), mask_not(mask_or(mask_or(left_ab, left_bc), left_ca)));
    const auto is_odd = [&](const Mask<F>& own, const Mask<F>& other_1, const Mask<F>& other_2, const F& size,
                            const F& size_1, const F& size_2) {
      const Mask<F> differs = mask_and(differ(own, other_1), differ(own, other_2));
      return mask_or(mask_and(mask_not(are_alike), differs),
                     mask_and(are_alike, size <= size_1, size <= size_2));
    };
    const Mask<F> is_bc = is_odd(left_bc, left_ab, left_ca, size_bc, size_ab, size_ca),
                  is_ca = is_odd(left_ca, left_ab, left_bc, size_ca, size_ab, size_bc);
    const auto pick = [&](const auto& if_ab, const auto& if_bc, const auto& if_ca) {
      return select(is_bc, if_bc, select(is_ca, if_ca, if_ab));
    };
    const Vec3<F> begin = pick(zero, b, c), end = pick(b, c, zero), middle = pick(c, zero, b);
    const F turn_long = pick(size_ab, size_bc, size_ca), turn_to_begin = pick(turn_ca, turn_ab, turn_bc);
    begin_ = a + begin;
    end_ = a + end;
    begin_to_middle_ = middle - begin;
    end_to_middle_ = middle - end;
    turn_begin_ = abs(turn_to_begin);
    turn_end_ = pick(size_bc, size_ca, size_ab);
    const F steep = F(1e6f) * length(a);
    const F rise = min(height * length(cross(b, c)) / max(turn_long, F(1e-30f)), steep);
    rise_ = select(turn_to_begin > F(0), rise, -rise);
    begin_area_ = ProjectedSector<F>(begin_, begin_to_middle_, rise_, turn_begin_).area();
  }

  /// A direction, unit. \param projected_solid_angle of the triangle (sr)
  Vec3<F> sample(const Vec2<F>& u, const F& projected_solid_angle) const {
    const F target = u.x * projected_solid_angle;
    const Mask<F> is_begin = target < begin_area_;
    const ProjectedSector<F> sector(select(is_begin, begin_, end_),
                                    select(is_begin, begin_to_middle_, end_to_middle_), rise_,
                                    select(is_begin, turn_begin_, turn_end_));
    const F share =
        select(is_begin, target / max(begin_area_, F(1e-30f)),
               F(1) - (target - begin_area_) / max(projected_solid_angle - begin_area_, F(1e-30f)));
    return sector.sample(max(min(share, F(1)), F(0)), u.y);
  }

 private:
  /// The z of cross(place, place + along).
  static F turn(const Vec3<F>& place, const Vec3<F>& along) { return place.x * along.y - place.y * along.x; }
  static Mask<F> differ(const Mask<F>& a, const Mask<F>& b) {
    return mask_or(mask_and(a, mask_not(b)), mask_and(b, mask_not(a)));
  }

  Vec3<F> begin_, end_;  ///< Of the long side.
  Vec3<F> begin_to_middle_, end_to_middle_;
  F rise_, turn_begin_, turn_end_, begin_area_;
};

}  // namespace etendue

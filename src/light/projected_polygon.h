// Directions in which a receiver sees a convex polygon, weighed by the cosine at the receiver: their measure,
// and directions with density in proportion to the cosine.
#pragma once

#include "light/horizon_clip.h"
#include "light/projected_triangle.h"
#include "light/zenith_triangle.h"

namespace etendue {

/// Peters 2021, "BRDF importance sampling for polygonal lights", with other parts: see
/// docs/light_sampling.md. A polygon around the zenith is cut into triangles between the zenith and its
/// sides, another into those of its fan.
template <class F>
class ProjectedPolygon {
 public:
  /// \param frame with the receiver's normal as n; the directions are local to it
  ProjectedPolygon(const PolygonFan<F>& fan, const Frame<F>& frame)
      : clip_(fan, frame),
        height_(max(fan.height, F(0))),
        has_zenith_(is_around_zenith()),
        is_small_(is_small(fan)) {
    // The first and the last side of a whole fan make no triangle.
    const bool is_whole_fan = !clip_.is_any_cut && !any(has_zenith_);
    first_side_ = is_whole_fan ? 1 : 0;
    end_side_ = std::size_t(clip_.sides) - (is_whole_fan ? 1 : 0);
    const Mask<F> needs_arcs = mask_or(has_zenith_, mask_not(is_small_));
    if (any(needs_arcs)) sum_arcs(needs_arcs);
    if (!all(needs_arcs)) sum_small(needs_arcs);
    projected_solid_angle_ = F(0);
    for (std::size_t k = first_side_; k < end_side_; ++k)
      projected_solid_angle_ = projected_solid_angle_ + parts_[k];
    constexpr float most_angles = 4096;  // Over the measure; each is off by some 2^-24.
    is_accurate_ = mask_and(projected_solid_angle_ > F(0), projected_solid_angle_ * F(most_angles) > angles_);
  }

  /// Of what is above the horizon (sr), 0 .. pi.
  const F& projected_solid_angle() const { return projected_solid_angle_; }

  /// Elsewhere rounding has eaten more than about 1e-4 of the measure: the polygon is a thin line to the
  /// receiver, or stands low over the horizon. Sampling by solid angle has no such trouble.
  const Mask<F>& is_accurate() const { return is_accurate_; }

  /// A direction, unit, with the density cos(theta) / projected_solid_angle(). Neighbours in u are neighbours
  /// but for the borders between the triangles of a fan.
  Vec3<F> sample(const Vec2<F>& u) const {
    const F target = u.x * projected_solid_angle_;
    Vec3<F> begin = clip_.begin[first_side_], end = clip_.end[first_side_];
    F before(0), part(1), sum(0);
    for (std::size_t k = first_side_; k < end_side_; ++k) {
      const Mask<F> is_here = mask_and(target >= sum, parts_[k] > F(0));
      begin = select(is_here, clip_.begin[k], begin);
      end = select(is_here, clip_.end[k], end);
      before = select(is_here, sum, before);
      part = select(is_here, parts_[k], part);
      sum = sum + parts_[k];
    }
    const Vec2<F> u_part{min((target - before) / part, F(1)), u.y};
    if (all(has_zenith_)) return below(begin, end).sample(u_part);
    const Vec3<F> first = first_corner();
    const ProjectedTriangle<F> triangle(clip_.first_corner + first, begin - first, end - first, height_);
    const Vec3<F> direction = triangle.sample(u_part, part);
    return any(has_zenith_) ? select(has_zenith_, below(begin, end).sample(u_part), direction) : direction;
  }

 private:
  /// Of the fan's triangles, from the whole polygon's first corner.
  Vec3<F> first_corner() const { return clip_.cut_begin; }

  Mask<F> is_around_zenith() const {
    Mask<F> is_left_of_none = clip_.first_corner.z == clip_.first_corner.z, is_right_of_any = F(0) > F(1);
    for (std::size_t k = 0; k < std::size_t(clip_.sides); ++k) {
      const Vec3<F> place = clip_.first_corner + clip_.begin[k], side = clip_.end[k] - clip_.begin[k];
      const F turn = place.x * side.y - place.y * side.x;
      is_left_of_none = mask_and(is_left_of_none, turn <= F(0));
      is_right_of_any = mask_or(is_right_of_any, turn < F(0));
    }
    return mask_and(is_left_of_none, is_right_of_any);
  }

  static Mask<F> is_small(const PolygonFan<F>& fan) {
    F width_sq(0);
    for (int k = 1; k < fan.most; ++k)
      width_sq =
          max(width_sq, select(less(Int<F>(k), fan.corners), length_sq(fan.from_apex[std::size_t(k)]), F(0)));
    constexpr float small = 0.08f;  // There six points give the measure to 1e-6.
    return width_sq < F(small * small) * length_sq(fan.apex);
  }

  /// \param begin, end from the whole polygon's first corner
  ZenithTriangle<F> below(const Vec3<F>& begin, const Vec3<F>& end) const {
    return {clip_.first_corner + begin, end - begin};
  }

  void sum_arcs(const Mask<F>& needs_arcs) {
    const Vec3<F> first = first_corner();
    const Mask<F> is_beside = mask_and(needs_arcs, mask_not(has_zenith_));
    const bool is_any_beside = any(is_beside);
    F spoke(0);
    if (is_any_beside) spoke = below(first, clip_.begin[first_side_]).signed_projected_solid_angle;
    for (std::size_t k = first_side_; k < end_side_; ++k) {
      const ZenithTriangle<F> side = below(clip_.begin[k], clip_.end[k]);
      parts_[k] = side.signed_projected_solid_angle;
      if (!is_any_beside) continue;
      const ZenithTriangle<F> next_spoke = below(first, clip_.end[k]);
      const Mask<F> is_triangle =
          mask_and(length_sq(clip_.begin[k] - first) > F(0), length_sq(clip_.end[k] - first) > F(0));
      // Others have no length: what the horizon cuts off, and what only neighbours in the packet have. Where
      // the horizon cuts, its crossings are rounded too.
      const Mask<F> is_side =
          mask_and(is_beside, length_sq(side.along) > F(0), mask_or(is_triangle, clip_.is_cut));
      const F triangle = spoke + parts_[k] - next_spoke.signed_projected_solid_angle;
      parts_[k] = select(is_beside, select(is_triangle, max(triangle, F(0)), F(0)), parts_[k]);
      spoke = next_spoke.signed_projected_solid_angle;
      angles_ = angles_ + select(is_side, side.angle + next_spoke.angle, F(0));
    }
  }

  /// cos(theta) dw = z height / |p|^4 dA over the triangles' areas, by the six points of Dunavant 1985 that
  /// are exact for polynomials of degree 4: nothing is subtracted.
  void sum_small(const Mask<F>& needs_arcs) {
    constexpr std::array near_a{0.445948490915965f, 0.223381589678011f},
        near_b{0.091576213509771f, 0.109951743655322f};
    const Vec3<F> first = first_corner(), place = clip_.first_corner + first;
    for (std::size_t k = first_side_; k < end_side_; ++k) {
      const Vec3<F> b = clip_.begin[k] - first, c = clip_.end[k] - first;
      F part(0);
      for (const auto& [share, weight] : {near_a, near_b})
        for (const auto& [to_b, to_c] :
             {std::array{share, share}, {1 - 2 * share, share}, {share, 1 - 2 * share}}) {
          const Vec3<F> p = place + b * F(to_b) + c * F(to_c);
          const F inv_sq = F(1) / length_sq(p);
          part = part + F(0.5f * weight) * max(p.z, F(0)) * inv_sq * inv_sq;
        }
      part = part * height_ * length(cross(b, c));
      parts_[k] = any(needs_arcs) ? select(needs_arcs, parts_[k], part) : part;
    }
  }

  HorizonClip<F> clip_;
  F height_;
  Mask<F> has_zenith_, is_small_;
  std::size_t first_side_, end_side_;      ///< Those that make triangles in some lane.
  std::array<F, most_corners + 1> parts_;  ///< The triangles' shares of the measure (sr).
  F projected_solid_angle_;
  F angles_ = F(0);  ///< Whose cosines were added and subtracted.
  Mask<F> is_accurate_;
};

}  // namespace etendue

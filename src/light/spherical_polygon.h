// The directions in which a receiver sees a convex polygon: their solid angle, and directions uniform in it.
#pragma once

#include "base/angles.h"
#include "light/polygon_fan.h"

namespace etendue {

/// Each triangle of the fan by its solid angle, and in it a point as in Arvo 1995, "Stratified sampling of
/// spherical triangles". Sides take the place of angles, so that small and far triangles lose nothing: see
/// docs/light_sampling.md.
template <class F>
class SphericalPolygon {
 public:
  explicit SphericalPolygon(const PolygonFan<F>& fan) : fan_(fan), apex_length_(length(fan.apex)) {
    solid_angle_ = F(0);
    Corner before = corner(1);
    for (int k = 2; k < fan.most; ++k) {
      const Corner here = corner(k);
      solid_angle_ = solid_angle_ + solid_angle_of_triangle(k, before, here);
      sums_[std::size_t(k)] = solid_angle_;
      before = here;
    }
  }

  /// Of the whole polygon (sr), 0 .. 2 pi; 0 where the receiver is not in front of it.
  const F& solid_angle() const { return solid_angle_; }

  /// A point of the polygon, from the receiver (m), in a direction of density 1 / solid_angle(). Neighbours
  /// in u lie side by side, over the borders of triangles too.
  Vec3<F> sample(const Vec2<F>& u) const {
    // The triangle, and how much of its solid angle lies between its first side and the point.
    const F target = u.x * solid_angle_;
    Vec3<F> first_side = fan_.from_apex[1], second_side = fan_.from_apex[2];
    F twice_area = fan_.twice_area[2], before(0);
    for (int k = 3; k < fan_.most; ++k) {
      const auto n = std::size_t(k);
      const Mask<F> is_beyond = mask_and(target >= sums_[n - 1], fan_.twice_area[n] > F(0));
      first_side = select(is_beyond, fan_.from_apex[n - 1], first_side);
      second_side = select(is_beyond, fan_.from_apex[n], second_side);
      twice_area = select(is_beyond, fan_.twice_area[n], twice_area);
      before = select(is_beyond, sums_[n - 1], before);
    }
    return in_triangle(first_side, second_side, twice_area, target - before, u.y);
  }

 private:
  struct Corner {
    Vec3<F> place;       ///< From the receiver (m).
    F length, dot_apex;  ///< m, m^2
  };
  Corner corner_at(const Vec3<F>& from_apex) const {
    const Vec3<F> place = fan_.apex + from_apex;
    return {place, length(place), dot(place, fan_.apex)};
  }
  Corner corner(int k) const { return corner_at(fan_.from_apex[std::size_t(k)]); }

  /// Van Oosterom and Strackee 1983, "The solid angle of a plane triangle", equation 8; the triple product is
  /// twice the area times the height.
  F solid_angle_of_triangle(int k, const Corner& b, const Corner& c) const {
    const F triple = max(fan_.height, F(0)) * fan_.twice_area[std::size_t(k)];
    const F cosines = apex_length_ * b.length * c.length + b.dot_apex * c.length + c.dot_apex * b.length +
                      dot(b.place, c.place) * apex_length_;
    return select(triple > F(0), F(2) * half_turn_angle(triple, cosines), F(0));
  }

  /// \param part of the triangle's solid angle that lies before the point (sr)
  Vec3<F> in_triangle(const Vec3<F>& first_side, const Vec3<F>& second_side, const F& twice_area,
                      const F& part, const F& u) const {
    const Corner b = corner_at(first_side), c = corner_at(second_side);
    const F inv_a = F(1) / apex_length_, inv_b = F(1) / b.length, inv_c = F(1) / c.length;
    const F cos_ab = b.dot_apex * inv_a * inv_b, cos_ac = c.dot_apex * inv_a * inv_c,
            cos_bc = dot(b.place, c.place) * inv_b * inv_c;
    const F triple = max(fan_.height, F(0)) * twice_area * inv_a * inv_b * inv_c;

    // The point on the side opposite to the apex that cuts this part off. It lies on the circle of all third
    // corners that give the part (Lexell), through the opposite directions of apex and b.
    F sine, cosine;
    sincos_half_turn(part * F(0.5f), sine, cosine);
    const F ratio =
        sine * (F(1) + cos_ab) / max(cosine * triple - sine * (cos_ac - cos_bc * cos_ab), F(least_divisor));
    const F to_c = F(2) * ratio * b.length,
            to_b =
                (F(1) - ratio * ratio * max(F(1) - cos_bc * cos_bc, F(0)) - F(2) * ratio * cos_bc) * c.length;
    const Vec3<F> side = first_side + (second_side - first_side) * share(to_c, to_b);

    // Between the apex and that point, uniform in the cosine of the angle from the apex.
    const Corner d = corner_at(side);
    const F cos_ad = d.dot_apex * inv_a / d.length;
    const F sin_half_sq = min(F(0.5f) * (F(1) - cos_ad), F(1));
    const F along = sqrt(u * (F(1) - u * sin_half_sq) / max(F(1) - sin_half_sq, F(least_divisor)));
    const F to_side = along * apex_length_,
            to_apex = (F(1) - F(2) * u * sin_half_sq - along * cos_ad) * d.length;
    return fan_.apex + side * share(to_side, to_apex);
  }

  static constexpr float least_divisor = 1e-15f;

  /// a / (a + b) of what rounding may have made negative.
  static F share(const F& a, const F& b) {
    const F rest = max(b, F(0));
    return a / max(a + rest, F(least_divisor));
  }

  const PolygonFan<F>& fan_;
  F apex_length_, solid_angle_;
  std::array<F, most_corners> sums_;  ///< Of the solid angles up to corner k.
};

}  // namespace etendue

// Directions in which a receiver sees a convex polygon, weighed by a glossy lobe.
#pragma once

#include "base/warp.h"
#include "bsdf/ltc.h"
#include "light/projected_polygon.h"

namespace etendue {

/// In proportion to a linearly transformed cosine: the polygon is seen through M^-1, sampled there in
/// proportion to the cosine, and the direction brought back (Heitz et al. 2016, section 4; Peters 2021,
/// section 6).
template <class F>
class LobePolygon {
 public:
  LobePolygon(const PolygonFan<F>& fan, const LinearlyTransformedCosine<F>& lobe)
      : lobe_(seen_from_front(fan, lobe)), polygon_(through(fan, lobe_), Frame<F>({F(0), F(0), F(1)})) {}

  /// Where the lobe varies little over the polygon: far from the lobe's middle, or small in it.
  static Mask<F> is_even(const PolygonFan<F>& fan, const LinearlyTransformedCosine<F>& lobe) {
    constexpr float far = 4;  // Sides away, seen through M^-1.
    const F area = lobe.inverse_determinant * fan.area * length(plane_normal(fan, lobe));
    return length_sq(lobe.cosine_from_lobe(fan.apex)) > F(far * far) * area;
  }

  /// The part of the lobe that meets the polygon, 0 .. 1.
  F share() const { return polygon_.projected_solid_angle() * F(inv_pi); }
  /// See ProjectedPolygon.
  const Mask<F>& is_accurate() const { return polygon_.is_accurate(); }

  /// Unit, world, with density pdf_solid_angle().
  Vec3<F> sample(const Vec2<F>& u) const { return normalize(lobe_.lobe_from_cosine(polygon_.sample(u))); }
  /// Of a direction (unit, world) that meets the polygon, 1/sr.
  F pdf_solid_angle(const Vec3<F>& wi) const {
    return lobe_.density_times_pi(wi) / polygon_.projected_solid_angle();
  }

 private:
  /// Behind a two-sided polygon its corners turn the other way, and so does the lobe's frame.
  static LinearlyTransformedCosine<F> seen_from_front(const PolygonFan<F>& fan,
                                                      LinearlyTransformedCosine<F> lobe) {
    lobe.row_x = select(fan.is_turned, -lobe.row_x, lobe.row_x);
    lobe.column_x = select(fan.is_turned, -lobe.column_x, lobe.column_x);
    return lobe;
  }

  /// Of the polygon's plane as it is seen through M^-1, not unit.
  static Vec3<F> plane_normal(const PolygonFan<F>& fan, const LinearlyTransformedCosine<F>& lobe) {
    return {dot(lobe.column_x, fan.ng), dot(lobe.column_y, fan.ng), dot(lobe.column_z, fan.ng)};
  }

  static PolygonFan<F> through(const PolygonFan<F>& fan, const LinearlyTransformedCosine<F>& lobe) {
    const Vec3<F> normal = plane_normal(fan, lobe);
    const F size = length(normal), growth = lobe.inverse_determinant * size;
    PolygonFan<F> seen = fan;
    seen.apex = lobe.cosine_from_lobe(fan.apex);
    for (std::size_t k = 1; k < std::size_t(fan.most); ++k) {
      seen.from_apex[k] = lobe.cosine_from_lobe(fan.from_apex[k]);
      seen.twice_area[k] = fan.twice_area[k] * growth;
    }
    seen.ng = normal * (F(1) / size);
    seen.height = fan.height * (F(1) / size);
    seen.area = fan.area * growth;
    return seen;
  }

  LinearlyTransformedCosine<F> lobe_;
  ProjectedPolygon<F> polygon_;
};

}  // namespace etendue

// A convex polygon that shines: samples by any technique, and their density.
#pragma once

#include "base/warp.h"
#include "light/light_sample.h"
#include "light/polygon_table.h"
#include "light/projected_polygon.h"
#include "light/spherical_polygon.h"
#include "light/technique.h"

namespace etendue {

/// One polygon for one receiver. Which technique serves a lane depends on both alone, so that samples and the
/// densities of hits agree.
template <class F>
class PolygonLight {
 public:
  /// \param row of the polygon in the table \param lanes that ask
  PolygonLight(const PolygonTable& table, const Int<F>& row, const Receiver<F>& receiver,
               const Mask<F>& is_twosided, LightTechnique technique, const Mask<F>& lanes)
      : receiver_(receiver),
        fan_(table.seen_from<F>(receiver.position, row, lanes, is_twosided)),
        by_area_(lanes) {
    const Mask<F> none = F(0) > F(1);
    by_cosine_ = none;
    is_seen_ = mask_and(lanes, fan_.height > F(0));
    if (technique == LightTechnique::solid_angle || technique == LightTechnique::projected_solid_angle)
      by_area_ = none;
    if (technique == LightTechnique::automatic || technique == LightTechnique::transformed_cosine)
      by_area_ = mask_and(lanes, is_small_from(length_sq(fan_.apex), fan_.spread));
    if (technique == LightTechnique::projected_solid_angle)
      by_cosine_ = mask_and(is_seen_, mask_not(by_area_), is_lit_from_one_side(receiver));
  }

  const Int<F>& label() const { return fan_.label; }  ///< Of the polygon in its table.

  /// \param longest_edge of the triangles there (m), for the clearance \param piece of the light
  LightSample<F> sample(const LightRequest<F>& request, const F& longest_edge, const Int<F>& piece) const {
    const Vec2<F> u{to_unit_float(request.u.x), to_unit_float(request.u.y)};
    const Vec3<F> origin = receiver_.position + fan_.apex;
    LightSample<F> result = no_light_sample<F>();
    if (any(by_area_)) {
      const Vec3<F> from_apex = uniform_in_fan(u);
      const F clear = clearance<F>(fan_.ng, abs_each(origin) + abs_each(from_apex), longest_edge);
      LightRequest<F> by_area = request;
      by_area.lanes = by_area_;
      result = light_sample_at({origin + from_apex, fan_.ng, F(1) / fan_.area, clear, piece}, by_area);
    }
    const auto take = [&](const Mask<F>& m, const Vec3<F>& to_light, const F& pdf) {
      const Vec3<F> from_apex = to_light - fan_.apex;
      const F clear =
          clearance<F>(fan_.ng, abs_each(origin) + abs_each(from_apex) + abs_each(to_light), longest_edge);
      const F pdf_solid_angle = request.pmf * pdf;
      const LightSample<F> sample{
          .wi = normalize(to_light),
          .end = receiver_.position + to_light + fan_.ng * clear,
          .radiance_over_pdf = request.strength * select(m, F(1) / pdf_solid_angle, F(0)),
          .pdf_solid_angle = select(m, pdf_solid_angle, F(0)),
          .is_there = m,
          .light = request.light,
          .piece = piece};
      result = select(m, sample, result);
    };
    by_directions(
        [&](const ProjectedPolygon<F>& polygon, const Frame<F>& frame, const Mask<F>& m) {
          const Vec3<F> wi = frame.world_from_local(polygon.sample(u));
          take(m, wi * fan_.distance_along(wi), cosine_density(polygon, frame, wi));
        },
        [&](const SphericalPolygon<F>& polygon, const Mask<F>& m) {
          take(m, polygon.sample(u), F(1) / polygon.solid_angle());
        });
    return result;
  }

  /// The density (1/sr) of a direction that meets the polygon, the choice of the light not included.
  F pdf_solid_angle(const LightHit<F>& hit) const {
    F pdf(0);
    if (any(by_area_)) pdf = select(by_area_, pdf_solid_angle_at(hit, receiver_, F(1) / fan_.area), pdf);
    by_directions([&](const ProjectedPolygon<F>& polygon, const Frame<F>& frame,
                      const Mask<F>& m) { pdf = select(m, cosine_density(polygon, frame, hit.wi), pdf); },
                  [&](const SphericalPolygon<F>& polygon, const Mask<F>& m) {
                    pdf = select(m, F(1) / polygon.solid_angle(), pdf);
                  });
    return pdf;
  }

  const PolygonFan<F>& fan() const { return fan_; }
  const Mask<F>& is_seen() const { return is_seen_; }  ///< From its front; of the lanes that ask.

 private:
  /// by_cosine(polygon, frame, lanes) and by_solid_angle(polygon, lanes), each where some lanes are its: the
  /// same ones for samples and for hits.
  template <class ByCosine, class BySolidAngle>
  void by_directions(const ByCosine& by_cosine, const BySolidAngle& by_solid_angle) const {
    Mask<F> left = mask_and(is_seen_, mask_not(by_area_));
    if (any(by_cosine_)) {
      const Frame<F> frame = receiver_frame();
      const ProjectedPolygon<F> polygon(fan_, frame);
      const Mask<F> m = mask_and(by_cosine_, polygon.is_accurate());
      left = mask_and(left, mask_not(m));
      if (any(m)) by_cosine(polygon, frame, m);
    }
    if (any(left)) {
      const SphericalPolygon<F> polygon(fan_);
      by_solid_angle(polygon, mask_and(left, polygon.solid_angle() > F(0)));
    }
  }

  /// Behind a two-sided polygon its corners turn the other way, and so does the frame.
  Frame<F> receiver_frame() const {
    Frame<F> frame(lit_normal(receiver_));
    frame.s = select(fan_.is_turned, -frame.s, frame.s);
    return frame;
  }

  static F cosine_density(const ProjectedPolygon<F>& polygon, const Frame<F>& frame, const Vec3<F>& wi) {
    // Rounding must not make it 0 for a direction along the horizon that was sampled.
    return max(dot(frame.n, wi), F(1e-7f)) / polygon.projected_solid_angle();
  }

  /// From the first corner (m).
  Vec3<F> uniform_in_fan(const Vec2<F>& u) const {
    const F target = u.y * F(2) * fan_.area;
    Vec3<F> first_side = fan_.from_apex[1], second_side = fan_.from_apex[2];
    F before(0), sum(0), twice_area = fan_.twice_area[2];
    for (std::size_t k = 3; k < std::size_t(fan_.most); ++k) {
      sum = sum + fan_.twice_area[k - 1];
      const Mask<F> is_beyond = mask_and(target >= sum, fan_.twice_area[k] > F(0));
      first_side = select(is_beyond, fan_.from_apex[k - 1], first_side);
      second_side = select(is_beyond, fan_.from_apex[k], second_side);
      twice_area = select(is_beyond, fan_.twice_area[k], twice_area);
      before = select(is_beyond, sum, before);
    }
    const Vec2<F> barycentric = square_to_triangle(
        Vec2<F>{u.x, min((target - before) / max(twice_area, F(1e-37f)), F(0x1.fffffep-1f))});
    return first_side * barycentric.x + second_side * barycentric.y;
  }

  const Receiver<F>& receiver_;
  PolygonFan<F> fan_;
  Mask<F> is_seen_, by_area_, by_cosine_;
};

}  // namespace etendue

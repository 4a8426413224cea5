// A convex polygon that shines at receivers of which some are glossy.
#pragma once

#include "light/lobe_polygon.h"
#include "light/polygon_light.h"

namespace etendue {

/// Where the receiver has a lobe that tells the parts of the polygon apart, samples come from two
/// distributions, chosen at random: the lobe's, and that of a diffuse receiver. Their density is that of the
/// mixture, so that what one of them leaves out (LTC have a horizon of their own) the other finds. Elsewhere
/// all is as of PolygonLight.
template <class F>
class GlossyPolygonLight {
 public:
  /// \param row of the polygon in the table \param lanes that ask
  GlossyPolygonLight(const PolygonTable& table, const Int<F>& row, const Receiver<F>& receiver,
                     const Mask<F>& is_twosided, LightTechnique technique, const Mask<F>& lanes)
      : polygon_(table, row, receiver, is_twosided, technique, lanes), receiver_(receiver) {
    if (receiver.lobes == nullptr) return;
    const bool is_by_scene = technique == LightTechnique::automatic;
    if (!is_by_scene && technique != LightTechnique::transformed_cosine) return;
    is_glossy_ = mask_and(polygon_.is_seen(), receiver.lobes->template has<F>(receiver.material),
                          equal(receiver.lit_sides, Int<F>(lit_side::front)));
    if (is_by_scene) is_glossy_ = mask_and(is_glossy_, may_be_uneven());
    if (!any(is_glossy_)) return;
    lobe_ = receiver.lobes->template at<F>(receiver.material, receiver.ns, receiver.wo);
    if (is_by_scene)
      is_glossy_ = mask_and(is_glossy_, mask_not(LobePolygon<F>::is_even(polygon_.fan(), lobe_.shape)));
    is_any_glossy_ = any(is_glossy_);
  }

  const Int<F>& label() const { return polygon_.label(); }  ///< As of PolygonLight.

  /// As of PolygonLight.
  LightSample<F> sample(const LightRequest<F>& request, const F& longest_edge, const Int<F>& piece) const {
    if (!is_any_glossy_) return polygon_.sample(request, longest_edge, piece);
    const LobePolygon<F> in_lobe(polygon_.fan(), lobe_.shape);
    const F share = lobe_share(in_lobe);
    const F u_x = to_unit_float(request.u.x);
    const Mask<F> is_by_lobe = u_x < share;
    const F stretched = select(is_by_lobe, u_x / max(share, F(1e-30f)), (u_x - share) / (F(1) - share));
    const F u_left = min(stretched, F(0x1.fffffep-1f));
    LightRequest<F> rest = request;
    rest.u.x = as_uint(to_int(u_left * F(0x1p24f))) << 8;
    const LightSample<F> diffuse = polygon_.sample(rest, longest_edge, piece);

    const PolygonFan<F>& fan = polygon_.fan();
    const Vec3<F> wi = select(is_by_lobe, in_lobe.sample({u_left, to_unit_float(request.u.y)}), diffuse.wi);
    const LightHit<F> hit{receiver_.position + wi * fan.distance_along(wi), fan.ng, wi, Int<F>(0)};
    const Vec3<F> to_light = hit.position - receiver_.position, from_apex = to_light - fan.apex;
    const F clear = clearance<F>(
        fan.ng, abs_each(receiver_.position + fan.apex) + abs_each(from_apex) + abs_each(to_light),
        longest_edge);
    const F pdf = request.pmf * mixture(in_lobe, share, hit);
    const Mask<F> is_there = mask_and(is_glossy_, mask_or(is_by_lobe, diffuse.is_there), pdf > F(0));
    const LightSample<F> mixed{.wi = wi,
                               .end = select(is_by_lobe, hit.position + fan.ng * clear, diffuse.end),
                               .radiance_over_pdf = request.strength * select(is_there, F(1) / pdf, F(0)),
                               .pdf_solid_angle = select(is_there, pdf, F(0)),
                               .is_there = is_there,
                               .light = request.light,
                               .piece = piece};
    return select(is_glossy_, mixed, diffuse);
  }

  /// As of PolygonLight.
  F pdf_solid_angle(const LightHit<F>& hit) const {
    if (!is_any_glossy_) return polygon_.pdf_solid_angle(hit);
    const LobePolygon<F> in_lobe(polygon_.fan(), lobe_.shape);
    return mixture(in_lobe, lobe_share(in_lobe), hit);
  }

 private:
  /// Not so small that the lobe hardly varies over it however it is turned: spares the look-up of the lobe.
  Mask<F> may_be_uneven() const {
    constexpr float far_sq = 64;
    return length_sq(polygon_.fan().apex) * receiver_.lobes->template narrowest<F>(receiver_.material) <
           F(far_sq) * polygon_.fan().spread;
  }

  /// Of the samples: what the lobe reflects of the polygon's light over what is scattered of it at all, with
  /// something left to each of both.
  F lobe_share(const LobePolygon<F>& in_lobe) const {
    constexpr float least = 0.1f;
    const PolygonFan<F>& fan = polygon_.fan();
    const F distance_sq = length_sq(fan.apex);
    const F solid_angle = min(fan.area * fan.height / (distance_sq * sqrt(distance_sq)), F(2 * pi));  // about
    const F by_lobe = lobe_.albedo * in_lobe.share(), beside = lobe_.diffuse * solid_angle * F(inv_pi);
    const F share = min(max(by_lobe / max(by_lobe + beside, F(1e-30f)), F(least)), F(1 - least));
    return select(mask_and(is_glossy_, in_lobe.is_accurate()), share, F(0));
  }

  F mixture(const LobePolygon<F>& in_lobe, const F& share, const LightHit<F>& hit) const {
    const F by_lobe = select(share > F(0), share * in_lobe.pdf_solid_angle(hit.wi), F(0));
    return by_lobe + (F(1) - share) * polygon_.pdf_solid_angle(hit);
  }

  PolygonLight<F> polygon_;
  const Receiver<F>& receiver_;
  Mask<F> is_glossy_ = F(0) > F(1);
  LobeAtReceiver<F> lobe_;
  bool is_any_glossy_ = false;
};

}  // namespace etendue

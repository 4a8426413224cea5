// A textured facet for one receiver: places by texels, and near to it also by solid angle.
#pragma once

#include "light/polygon_light.h"
#include "light/texel_sampling.h"

#include <optional>

namespace etendue {

/// Texels tell what a place shines, not how near it is. So where the facet is not small for its distance, a
/// share of its samples goes by solid angle, the more the less its texels differ; the density is that of both
/// (the one-sample model of Veach 1997, section 9.2.4, with the balance heuristic). What is near depends on
/// facet and receiver alone, so that samples and the densities of hits agree.
template <class F>
class TexelMixture {
 public:
  /// \param polygons of the facets \param facet valid in all lanes \param lanes that ask
  TexelMixture(const TexelTable& texels, const PolygonTable& polygons, const Int<F>& facet,
               const Receiver<F>& receiver, const Mask<F>& is_twosided, const Mask<F>& lanes)
      : texels_(texels), facet_(facet), receiver_(receiver) {
    const auto [apex, spread] = polygons.apex_and_spread<F>(facet);
    is_near_ = mask_and(lanes, mask_not(is_small_from(length_sq(apex - receiver.position), spread)));
    if (!any(is_near_)) return;
    constexpr float least = 0.1f;
    share_ = min(max(texels.template flatness<F>(facet), F(least)), F(1 - least));
    polygon_.emplace(polygons, facet, receiver, is_twosided, LightTechnique::solid_angle, is_near_);
  }

  /// Of unit radiance. \param longest_edge of the triangles there (m) \param piece of the light
  LightSample<F> sample(const LightRequest<F>& request, const F& longest_edge, const Int<F>& piece) const {
    if (!polygon_) return by_texels(request, longest_edge, piece);
    LightRequest<F> asked = request;
    const F u = to_unit_float(request.u.x);
    const Mask<F> is_by_direction = mask_and(is_near_, u < share_);
    const F rest =
        min(select(is_by_direction, u / share_, (u - share_) / (F(1) - share_)), F(0x1.fffffep-1f));
    const UInt<F> stretched = as_uint(to_int(max(rest, F(0)) * F(0x1p24f))) << 8;
    asked.u.x = as_uint(select(is_near_, as_int(stretched), as_int(request.u.x)));
    LightSample<F> sample = by_texels(asked, longest_edge, piece);
    const F pdf_of_cell = sample.pdf_solid_angle;
    if (any(is_by_direction))
      sample = select(is_by_direction, polygon_->sample(asked, longest_edge, piece), sample);
    const F distance = polygon_->fan().distance_along(sample.wi);
    const LightHit<F> hit{receiver_.position + sample.wi * distance, polygon_->fan().ng, sample.wi, facet_};
    // Of the cell that was drawn: the place may round into the next one, where another texel shines.
    const F pdf_texels = select(is_by_direction, request.pmf * pdf_by_texels(hit), pdf_of_cell);
    const F pdf = (F(1) - share_) * pdf_texels + share_ * request.pmf * polygon_->pdf_solid_angle(hit);
    const Mask<F> is_there = mask_and(sample.is_there, pdf > F(0));
    sample.radiance_over_pdf =
        select(is_near_, request.strength * select(is_there, F(1) / pdf, F(0)), sample.radiance_over_pdf);
    sample.pdf_solid_angle = select(is_near_, select(is_there, pdf, F(0)), sample.pdf_solid_angle);
    sample.is_there = mask_or(mask_and(is_near_, is_there), mask_and(mask_not(is_near_), sample.is_there));
    return sample;
  }

  /// The density (1/sr) of a direction that meets the facet, the choice of the facet not included.
  F pdf_solid_angle(const LightHit<F>& hit) const {
    const F by_texels = pdf_by_texels(hit);
    if (!polygon_) return by_texels;
    return select(is_near_, (F(1) - share_) * by_texels + share_ * polygon_->pdf_solid_angle(hit), by_texels);
  }

 private:
  F pdf_by_texels(const LightHit<F>& hit) const {
    return pdf_solid_angle_at(hit, receiver_, texels_.template pdf_area<F>(facet_, hit.position));
  }
  LightSample<F> by_texels(const LightRequest<F>& request, const F& longest_edge, const Int<F>& piece) const {
    const auto place = texels_.template sample<F>(facet_, request.u);
    const F clear = clearance<F>(place.ng, place.terms, longest_edge);
    return light_sample_at({place.position, place.ng, place.pdf_area, clear, piece}, request);
  }

  const TexelTable& texels_;
  Int<F> facet_;
  const Receiver<F>& receiver_;
  Mask<F> is_near_;
  F share_ = F(0);  ///< By solid angle.
  std::optional<PolygonLight<F>> polygon_;
};

}  // namespace etendue

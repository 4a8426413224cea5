// TexturedLights as whole lights, over lanes.
#pragma once

#include "light/textured_light.h"

namespace etendue {

template <class F>
LightSample<F> TexturedLights::shining(const LightRequest<F>& request, const Int<F>& patch,
                                       LightSample<F> sample) const {
  const Color<F> color =
      radiance<F>(request.row, texels_.uv_at<F>(patch, sample.end), mask_and(request.lanes, sample.is_there));
  sample.radiance_over_pdf = sample.radiance_over_pdf * color;
  return sample;
}

template <class F>
LightSample<F> TexturedLights::sample_by_area(const LightRequest<F>& request) const {
  const Int<F> first = select(request.lanes, first_patch_.at(request.row), Int<F>(0));
  const InversionSample<F> chosen =
      sample_by_inversion<F>(area_shares_.data(), first + select(request.lanes, request.row, Int<F>(0)),
                             patch_count_.at(request.row), most_patches_, request.u.y);
  const Int<F> patch = first + chosen.index;
  const auto place = texels_.uniform<F>(patch, {to_unit_float(request.u.x), chosen.u_left});
  const F clear = clearance<F>(place.ng, place.terms, longest_edge_.at(request.row));
  const Int<F> piece = to_int(to_unit_float(request.u.y) * F(float(light_pieces)));
  return shining<F>(
      request, patch,
      light_sample_at({place.position, place.ng, pdf_area_.at(request.row), clear, piece}, request));
}

template <class F>
void TexturedLights::choose_facet(LightRequest<F>& request) const {
  const Mask<F> is_whole = less(request.facet, Int<F>(0));
  const Int<F> first = first_share<F>(request.row);
  const InversionSample<F> facet = sample_by_inversion<F>(
      weight_shares_.data(), first, facet_count_.at(request.row), most_facets_, request.u.y);
  request.facet = select(is_whole, facet.index, request.facet);
  const UInt<F> left = as_uint(to_int(facet.u_left * F(0x1p24f))) << 8;
  request.u.y = as_uint(select(is_whole, as_int(left), as_int(request.u.y)));
  const F share = inversion_pmf<F>(weight_shares_.data(), first, facet.index);
  request.pmf = select(is_whole, request.pmf * share, request.pmf);
}

}  // namespace etendue

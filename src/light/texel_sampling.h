// TexelTable's samples and densities, over lanes.
#pragma once

#include "base/warp.h"
#include "geometry/clearance.h"
#include "light/inversion_table.h"
#include "light/sample_linear.h"
#include "light/texel_lanes.h"

namespace etendue {

/// \param at in the cell
template <class F>
F TexelTable::pdf_in(const PatchLanes<F>& patch, const FacetLanes<F>& facet, const Cell<F>& cell,
                     const Vec2<F>& at) const {
  const Int<F> row = cell.t - facet.first_t;
  const F pmf =
      inversion_pmf<F>(row_shares_.data(), facet.first_row_share, row) *
      inversion_pmf<F>(column_shares_.data(), facet.first_column_share + row * (facet.cells_s + Int<F>(1)),
                       cell.s - facet.first_s);
  const auto& h = cell.heights;
  const F s0 = F(1) - at.x,
          height = (h[0] * s0 + h[1] * at.x) * (F(1) - at.y) + (h[2] * s0 + h[3] * at.x) * at.y;
  const F mean = (h[0] + h[1] + h[2] + h[3]) * F(0.25f);
  const F shape = select(cell.is_linear, height / max(mean, F(1e-37f)), F(1));
  return pmf * shape * patch.per_area * select(cell.is_cut, F(2), F(1)) / (cell.s_size * cell.t_size);
}

template <class F>
TexelTable::Place<F> TexelTable::sample(const Int<F>& facet, const Vec2<UInt<F>>& u) const {
  const FacetLanes<F> f = facets_at<F>(facet);
  const PatchLanes<F> patch = patches_at<F>(f.patch);
  const InversionSample<F> row =
      sample_by_inversion<F>(row_shares_.data(), f.first_row_share, f.cells_t, most_rows_, u.y);
  const InversionSample<F> column = sample_by_inversion<F>(
      column_shares_.data(), f.first_column_share + row.index * (f.cells_s + Int<F>(1)), f.cells_s,
      most_columns_, u.x);
  const Cell<F> cell = cell_at<F>(patch, f.first_s + column.index, f.first_t + row.index);
  Vec2<F> at{column.u_left, row.u_left};
  if (any(cell.is_linear)) {
    const auto& h = cell.heights;
    const F y = sample_linear(row.u_left, h[0] + h[1], h[2] + h[3]);
    const F x = sample_linear(column.u_left, h[0] * (F(1) - y) + h[2] * y, h[1] * (F(1) - y) + h[3] * y);
    at = {select(cell.is_linear, x, at.x), select(cell.is_linear, y, at.y)};
  }
  const Mask<F> is_beyond = mask_and(cell.is_cut, at.x + at.y > F(1));
  at = {select(is_beyond, F(1) - at.x, at.x), select(is_beyond, F(1) - at.y, at.y)};
  const Vec3<F> along_s = patch.edge_s * (cell.s_begin + at.x * cell.s_size),
                along_t = patch.edge_t * (cell.t_begin + at.y * cell.t_size);
  return {patch.origin + along_s + along_t, abs_each(patch.origin) + abs_each(along_s) + abs_each(along_t),
          patch.ng, pdf_in<F>(patch, f, cell, at)};
}

/// Along both sides of the patch, 0 to 1; on a triangle, or on its long side.
template <class F>
Vec2<F> TexelTable::on_patch(const PatchLanes<F>& patch, const Vec3<F>& position) {
  const Vec3<F> from_origin = position - patch.origin;
  const F s = min(max(dot(patch.dual_s, from_origin), F(0)), F(1)),
          t = min(max(dot(patch.dual_t, from_origin), F(0)), F(1));
  const F beyond = select(patch.is_triangle, max(s + t - F(1), F(0)) * F(0.5f), F(0));
  return {max(s - beyond, F(0)), max(t - beyond, F(0))};
}

template <class F>
F TexelTable::pdf_area(const Int<F>& facet, const Vec3<F>& position) const {
  using I = Int<F>;
  const FacetLanes<F> f = facets_at<F>(facet);
  const PatchLanes<F> patch = patches_at<F>(f.patch);
  const Vec2<F> place = on_patch<F>(patch, position);
  // A place that rounding puts beside the facet belongs to the cell at its edge.
  const auto number = [](const F& x, const I& first, const I& count) {
    const I k = to_int(x), last = first + count - I(1);
    const I at_least = select(less(k, first), first, k);
    return select(less(last, at_least), last, at_least);
  };
  I s = number(place.x * patch.cells_per_s + patch.offset_s, f.first_s, f.cells_s);
  const I t = number(place.y * patch.cells_per_t + patch.offset_t, f.first_t, f.cells_t);
  s = select(mask_and(patch.is_triangle, mask_not(less(s + t, patch.cells_s))), patch.cells_s - t - I(1), s);
  const Cell<F> cell = cell_at<F>(patch, s, t);
  const auto within = [](const F& x, const F& begin, const F& size) {
    return min(max((x - begin) / size, F(0)), F(1));
  };
  return pdf_in<F>(patch, f, cell,
                   {within(place.x, cell.s_begin, cell.s_size), within(place.y, cell.t_begin, cell.t_size)});
}

template <class F>
Int<F> TexelTable::facet_at(const Int<F>& patch, const Vec3<F>& position) const {
  using I = Int<F>;
  const PatchLanes<F> p = patches_at<F>(patch);
  const Vec2<F> place = on_patch<F>(p, position);
  const auto whole = [](const F& x) { return as_int(float_as_bits(x)); };
  const auto sizes = patch_column<F>(patch, 32), last = patch_column<F>(patch, 36);
  const auto number = [](const F& x, const I& cells, const I& a_facet) {
    const I k = to_int(x), cell = select(less(k, cells), k, cells - I(1));
    return to_int((to_float(cell) + F(0.5f)) / to_float(a_facet));
  };
  const I s = number(place.x * p.cells_per_s + p.offset_s, p.cells_s, whole(sizes[3]));
  const I t = number(place.y * p.cells_per_t + p.offset_t, p.cells_t, whole(last[0]));
  return select(p.is_triangle, whole(sizes[1]), whole(sizes[1]) + t * whole(sizes[2]) + s);
}

template <class F>
F TexelTable::flatness(const Int<F>& facet) const {
  return gather(&facets_.front().flatness, facet * Int<F>(facet_words));
}

template <class F>
Int<F> TexelTable::patch_of(const Int<F>& facet) const {
  return gather(&facets_.front().patch, facet * Int<F>(facet_words));
}

template <class F>
TexelTable::Place<F> TexelTable::uniform(const Int<F>& patch, const Vec2<F>& u) const {
  const PatchLanes<F> p = patches_at<F>(patch);
  const Vec2<F> folded = square_to_triangle(u);
  const Vec3<F> along_s = p.edge_s * select(p.is_triangle, folded.x, u.x),
                along_t = p.edge_t * select(p.is_triangle, folded.y, u.y);
  return {p.origin + along_s + along_t, abs_each(p.origin) + abs_each(along_s) + abs_each(along_t), p.ng,
          F(0)};
}

template <class F>
Vec2<F> TexelTable::uv_at(const Int<F>& patch, const Vec3<F>& position) const {
  const PatchLanes<F> p = patches_at<F>(patch);
  const Vec2<F> place = on_patch<F>(p, position);
  const auto a = patch_column<F>(patch, 24), b = patch_column<F>(patch, 28);
  return {a[0] + a[2] * place.x + b[0] * place.y, a[1] + a[3] * place.x + b[1] * place.y};
}

}  // namespace etendue

// What TexelTable holds of a facet, its patch and a cell, over lanes.
#pragma once

#include "base/gather.h"
#include "base/simd_math.h"
#include "light/texel_table.h"

#include <array>

namespace etendue {

template <class F>
struct TexelTable::FacetLanes {
  Int<F> patch, first_s, first_t, cells_s, cells_t, first_row_share, first_column_share;
};

template <class F>
struct TexelTable::PatchLanes {
  Vec3<F> origin, edge_s, edge_t, dual_s, dual_t, ng;
  F cells_per_s, offset_s, cells_per_t, offset_t, per_area;
  Mask<F> is_triangle;
  Int<F> cells_s, cells_t, first_height;
};

/// One cell of a patch. Places in it run from 0 to 1 along both sides; in one that the long side of a
/// triangle cuts in two, those beyond it are turned about its middle.
template <class F>
struct TexelTable::Cell {
  Int<F> s, t;
  F s_begin, s_size, t_begin, t_size;
  Mask<F> is_cut, is_linear;
  std::array<F, 4> heights;  ///< At (0, 0), (1, 0), (0, 1), (1, 1).
};

template <class F>
std::array<F, 4> TexelTable::patch_column(const Int<F>& patch, int column) const {
  return gather_four(&patches_.front().origin.x + column, patch * Int<F>(patch_words));
}

template <class F>
TexelTable::FacetLanes<F> TexelTable::facets_at(const Int<F>& facet) const {
  const Int<F> at = facet * Int<F>(facet_words);
  const auto column = [&](int k) { return gather(&facets_.front().patch + k, at); };
  return {column(0), column(1), column(2), column(3), column(4), column(5), column(6)};
}

template <class F>
TexelTable::PatchLanes<F> TexelTable::patches_at(const Int<F>& patch) const {
  const auto vec = [](const std::array<F, 4>& n) { return Vec3<F>{n[0], n[1], n[2]}; };
  const auto whole = [](const F& x) { return as_int(float_as_bits(x)); };
  const auto a = patch_column<F>(patch, 0), b = patch_column<F>(patch, 4), c = patch_column<F>(patch, 8),
             d = patch_column<F>(patch, 12), e = patch_column<F>(patch, 16), f = patch_column<F>(patch, 20),
             g = patch_column<F>(patch, 28), h = patch_column<F>(patch, 32);
  return {vec(a),      vec(b),      vec(c),     vec(d), vec(e), vec(f),
          a[3],        b[3],        c[3],       d[3],   e[3],   less(Int<F>(0), whole(f[3])),
          whole(g[2]), whole(g[3]), whole(h[0])};
}

template <class F>
TexelTable::Cell<F> TexelTable::cell_at(const PatchLanes<F>& patch, const Int<F>& s, const Int<F>& t) const {
  const auto begin = [](const Int<F>& k, const F& per_unit, const F& offset, const Int<F>& count) {
    return select(less(k, count), max((to_float(k) - offset) / per_unit, F(0)), F(1));
  };
  const Int<F> one(1);
  Cell<F> cell;
  cell.s = s;
  cell.t = t;
  cell.s_begin = begin(s, patch.cells_per_s, patch.offset_s, patch.cells_s);
  cell.t_begin = begin(t, patch.cells_per_t, patch.offset_t, patch.cells_t);
  cell.s_size = begin(s + one, patch.cells_per_s, patch.offset_s, patch.cells_s) - cell.s_begin;
  cell.t_size = begin(t + one, patch.cells_per_t, patch.offset_t, patch.cells_t) - cell.t_begin;
  cell.is_cut = mask_and(patch.is_triangle, equal(s + t + one, patch.cells_s));
  cell.is_linear = less(Int<F>(-1), patch.first_height);
  const Int<F> below = select(cell.is_linear, patch.first_height + t * (patch.cells_s + one) + s, Int<F>(0)),
               above = select(cell.is_linear, below + patch.cells_s + one, Int<F>(0));
  cell.heights = {gather(heights_.data(), below), gather(heights_.data() + 1, below),
                  gather(heights_.data(), above), gather(heights_.data() + 1, above)};
  return cell;
}

}  // namespace etendue

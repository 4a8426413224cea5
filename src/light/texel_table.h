// Textured patches cut into cells about as large as texels: places drawn in proportion to their light.
#pragma once

#include "light/textured_patches.h"
#include "texture/texture.h"

#include <array>
#include <cstdint>
#include <vector>

namespace etendue {

/// Patches by row. A parallelogram is cut into facets, rectangles of its cells; a triangle is one facet.
/// Where a patch lies along the axes of the texture, the texture is smooth within each cell, and the density
/// follows its luminance. Elsewhere the density of a cell is constant: its mean luminance, or a twentieth of
/// the largest there, which keeps it above 0 wherever there is light.
class TexelTable {
 public:
  struct Limits {
    int facets_a_side;  ///< Of a parallelogram.
    int most_cells;     ///< Of a patch.
  };
  /// \param brightest as largest_luminance of the whole texture
  void add(const TexturedPatch& patch, const ColorTexture& texture, double brightest, const Limits& limits);

  std::int32_t patch_count() const { return std::int32_t(patches_.size()); }
  std::int32_t facet_count() const { return std::int32_t(facets_.size()); }
  /// The integral of what the density follows over a facet (m^2 times luminance); 0 only where it is black.
  double weight(std::int32_t facet) const { return weights_[std::size_t(facet)]; }
  /// The integral of the luminance itself.
  double integral(std::int32_t facet) const { return integrals_[std::size_t(facet)]; }
  /// Of a facet, turning to the left seen from the front (m).
  std::vector<Vec3f> corners(std::int32_t facet) const;

  template <class F>
  struct Place {
    Vec3<F> position;  ///< World, m.
    Vec3<F> terms;     ///< What it was added up from, as clearance() asks.
    Vec3<F> ng;        ///< Unit.
    F pdf_area;        ///< 1/m^2
  };
  // Lanes outside of a caller's own must hold valid rows too.
  template <class F>
  Place<F> sample(const Int<F>& facet, const Vec2<UInt<F>>& u) const;
  /// The density (1/m^2) with which `sample` gives the place of the facet that is nearest to `position`.
  template <class F>
  F pdf_area(const Int<F>& facet, const Vec3<F>& position) const;
  /// Uniform over a patch; without its density.
  template <class F>
  Place<F> uniform(const Int<F>& patch, const Vec2<F>& u) const;
  double area(std::int32_t patch) const;  ///< m^2
  template <class F>
  Int<F> patch_of(const Int<F>& facet) const;
  template <class F>
  Int<F> facet_at(const Int<F>& patch, const Vec3<F>& position) const;
  /// (mean of the luminance)^2 / mean of its square, over the cells of a facet, 0 to 1; 1 where it is black.
  template <class F>
  F flatness(const Int<F>& facet) const;
  template <class F>
  Vec2<F> uv_at(const Int<F>& patch, const Vec3<F>& position) const;

 private:
  /// Along s cell k begins at (k - offset_s) / cells_per_s, but the first at 0; the last ends at 1. So along
  /// t.
  struct Patch {
    Vec3f origin;
    float cells_per_s;
    Vec3f edge_s;
    float offset_s;
    Vec3f edge_t;
    float cells_per_t;
    Vec3f dual_s;  ///< s is its dot product with the way from the origin.
    float offset_t;
    Vec3f dual_t;
    float per_area;  ///< 1 / that of the parallelogram (1/m^2).
    Vec3f ng;
    std::int32_t is_triangle;
    Vec2f uv, uv_s;
    Vec2f uv_t;
    std::int32_t cells_s, cells_t;
    std::int32_t first_height;  ///< Of the luminance at the cells' corners, row by row; -1: constant in each.
    std::int32_t first_facet, facets_s, cells_a_facet_s;
    std::int32_t cells_a_facet_t, unused[3] = {0, 0, 0};
  };
  struct Facet {
    std::int32_t patch, first_s, first_t, cells_s;
    std::int32_t cells_t, first_row_share, first_column_share;
    float flatness;
  };
  static constexpr std::int32_t patch_words = sizeof(Patch) / sizeof(float),
                                facet_words = sizeof(Facet) / sizeof(float);
  template <class F>
  struct PatchLanes;
  template <class F>
  struct FacetLanes;
  template <class F>
  struct Cell;
  class Builder;

  template <class F>
  std::array<F, 4> patch_column(const Int<F>& patch, int column) const;
  template <class F>
  FacetLanes<F> facets_at(const Int<F>& facet) const;
  template <class F>
  PatchLanes<F> patches_at(const Int<F>& patch) const;
  template <class F>
  Cell<F> cell_at(const PatchLanes<F>& patch, const Int<F>& s, const Int<F>& t) const;
  template <class F>
  F pdf_in(const PatchLanes<F>& patch, const FacetLanes<F>& facet, const Cell<F>& cell,
           const Vec2<F>& at) const;
  template <class F>
  static Vec2<F> on_patch(const PatchLanes<F>& patch, const Vec3<F>& position);

  std::vector<Patch> patches_;
  std::vector<Facet> facets_;
  std::vector<double> weights_, integrals_;  ///< Of facets.
  std::vector<std::int32_t> row_shares_;     ///< Cumulative, of the rows of each facet.
  std::vector<std::int32_t> column_shares_;  ///< Of the cells of each row.
  std::vector<float> heights_ = {0};
  std::int32_t most_rows_ = 1, most_columns_ = 1;  ///< Of any facet.
};

}  // namespace etendue

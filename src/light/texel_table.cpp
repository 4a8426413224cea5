#include "light/texel_table.h"

#include "light/inversion_table.h"
#include "texture/texels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace etendue {

namespace {

/// Of a texel, what rounding of texture coordinates may move a line.
constexpr double line_tolerance = 1e-4;
constexpr int most_cells_a_side = 1 << 12;
constexpr double few_cells = 1 << 16, most_cells_a_texel = 4;
/// Of the largest luminance in a cell that the texture is not smooth in, what its density follows at least.
constexpr double least_share = 0.05;

/// Cell k begins at (k - offset) / per_unit of the side, but the first at 0; the last ends at 1.
struct Cells {
  double per_unit = 1, offset = 0;
  int count = 1;

  double begin(int k) const { return k == 0 ? 0 : k >= count ? 1 : (k - offset) / per_unit; }
};

/// Between the lines where first + along x is whole.
Cells between_lines(double first, double along) {
  Cells cells;
  if (std::abs(along) < line_tolerance) return cells;
  cells.per_unit = std::abs(along);
  const double at_begin = along > 0 ? first : -first;
  cells.offset = at_begin - std::floor(at_begin);
  if (cells.offset < line_tolerance || cells.offset > 1 - line_tolerance) cells.offset = 0;
  cells.count = int(std::clamp(std::ceil(cells.offset + cells.per_unit - line_tolerance), 1.0, 1e9));
  return cells;
}

Cells even(double count, int most) {
  const int n = int(std::clamp(std::ceil(count - line_tolerance), 1.0, double(most)));
  return {double(n), 0, n};
}

/// Its cells, and whether the texture is smooth within each.
struct Grid {
  Cells s, t;
  bool is_smooth;
};

Grid grid_of(const TexturedPatch& patch, const TexelLattice& lattice, int most_cells) {
  const Vec2<double> first{patch.uv.x * lattice.per_unit.x - lattice.offset.x,
                           patch.uv.y * lattice.per_unit.y - lattice.offset.y};
  const auto in_texels = [&](const Vec2<double>& uv) {
    return Vec2<double>{uv.x * lattice.per_unit.x, uv.y * lattice.per_unit.y};
  };
  const Vec2<double> along_s = in_texels(patch.uv_s), along_t = in_texels(patch.uv_t);
  const auto is_none = [](double texels) { return std::abs(texels) < line_tolerance; };
  const bool is_straight = is_none(along_s.y) && is_none(along_t.x),
             is_across = is_none(along_s.x) && is_none(along_t.y);
  if (!patch.is_triangle && lattice.between != TexelLattice::Between::other && (is_straight || is_across)) {
    const Grid grid{is_straight ? between_lines(first.x, along_s.x) : between_lines(first.y, along_s.y),
                    is_straight ? between_lines(first.y, along_t.y) : between_lines(first.x, along_t.x),
                    true};
    if (std::max(grid.s.count, grid.t.count) <= most_cells_a_side &&
        double(grid.s.count) * grid.t.count <= most_cells)
      return grid;
  }
  const auto texels = [](const Vec2<double>& along) {
    return std::max(std::abs(along.x), std::abs(along.y));
  };
  double s = std::max(texels(along_s), 1.0), t = std::max(texels(along_t), 1.0);
  if (patch.is_triangle) s = t = std::max(s, t);
  // Finer than texels while that costs little: lines of the texture run through the cells.
  const double finer =
      std::clamp(std::sqrt(std::min(few_cells, double(most_cells)) / (s * t)), 1.0, most_cells_a_texel);
  s *= finer, t *= finer;
  const double shrink = std::sqrt(std::min(1.0, most_cells / (s * t)));
  const int most = std::max(std::min(most_cells_a_side, most_cells), 1);
  return {even(s * shrink, most), even(t * shrink, most), false};
}

}  // namespace

/// Of one patch.
class TexelTable::Builder {
 public:
  Builder(const TexturedPatch& patch, const ColorTexture& texture, double brightest, const Limits& limits)
      : patch_(patch),
        texture_(texture),
        lattice_(texel_lattice(texture)),
        brightest_(brightest),
        grid_(grid_of(patch, lattice_, limits.most_cells)) {}

  const Grid& grid() const { return grid_; }
  bool is_linear() const { return grid_.is_smooth && lattice_.between == TexelLattice::Between::bilinear; }

  double luminance_at(double s, double t) const {
    const Vec2<double> uv = uv_at(s, t);
    return luminance(color_at<float>(texture_, {float(uv.x), float(uv.y)}, true));
  }

  struct Weights {
    double followed, integral;  ///< Of what the density follows, and of the luminance, over the cell.
    double area;                ///< In (s, t).
  };
  Weights cell(int i, int j) const {
    const double s0 = grid_.s.begin(i), s1 = grid_.s.begin(i + 1), t0 = grid_.t.begin(j),
                 t1 = grid_.t.begin(j + 1);
    const double area = (s1 - s0) * (t1 - t0);
    if (is_linear()) {
      const double mean =
          (luminance_at(s0, t0) + luminance_at(s1, t0) + luminance_at(s0, t1) + luminance_at(s1, t1)) / 4;
      return {mean * area, mean * area, area};
    }
    if (grid_.is_smooth) {
      const double value = luminance_at((s0 + s1) / 2, (t0 + t1) / 2);
      return {value * area, value * area, area};
    }
    if (patch_.is_triangle && i + j >= grid_.s.count) return {0, 0, 0};
    const bool is_cut = patch_.is_triangle && i + j == grid_.s.count - 1;
    const double largest = largest_in(s0, s1, t0, t1), mean = mean_in(s0, s1, t0, t1, is_cut);
    const double share = is_cut ? 0.5 : 1;
    return {std::max(mean, least_share * largest) * area * share, mean * area * share, area * share};
  }

 private:
  Vec2<double> uv_at(double s, double t) const {
    return {patch_.uv.x + patch_.uv_s.x * s + patch_.uv_t.x * t,
            patch_.uv.y + patch_.uv_s.y * s + patch_.uv_t.y * t};
  }

  double texels_across(double s, double t) const {
    return std::abs((patch_.uv_s.x * s + patch_.uv_t.x * t) * lattice_.per_unit.x) +
           std::abs((patch_.uv_s.y * s + patch_.uv_t.y * t) * lattice_.per_unit.y);
  }

  /// At places not farther apart than half a texel, unless the cell has very many.
  double mean_in(double s0, double s1, double t0, double t1, bool is_cut) const {
    const auto places = [](double texels) { return int(std::clamp(std::ceil(2 * texels), 2.0, 64.0)); };
    const int columns = places(texels_across(s1 - s0, 0)), rows = places(texels_across(0, t1 - t0));
    double sum = 0;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        double x = (i + 0.5) / columns, y = (j + 0.5) / rows;
        if (is_cut && x + y > 1) x = 1 - x, y = 1 - y;
        sum += luminance_at(s0 + x * (s1 - s0), t0 + y * (t1 - t0));
      }
    return sum / (double(rows) * columns);
  }

  double largest_in(double s0, double s1, double t0, double t1) const {
    constexpr double many_texels = 4096;
    if (texels_across(s1 - s0, 0) * texels_across(0, t1 - t0) > many_texels) return brightest_;
    Vec2<double> low = uv_at(s0, t0), high = low;
    for (const Vec2<double>& uv : {uv_at(s1, t0), uv_at(s0, t1), uv_at(s1, t1)}) {
      low = {std::min(low.x, uv.x), std::min(low.y, uv.y)};
      high = {std::max(high.x, uv.x), std::max(high.y, uv.y)};
    }
    return largest_luminance(texture_, low, high);
  }

  const TexturedPatch& patch_;
  const ColorTexture& texture_;
  TexelLattice lattice_;
  double brightest_;
  Grid grid_;
};

void TexelTable::add(const TexturedPatch& patch, const ColorTexture& texture, double brightest,
                     const Limits& limits) {
  const Builder builder(patch, texture, brightest, limits);
  const Cells &s = builder.grid().s, &t = builder.grid().t;
  const Vec3<double> across = cross(patch.edge_s, patch.edge_t);
  const double area_sq = length_sq(across), area = std::sqrt(area_sq);
  const auto a_facet = [&](int count) {
    const int facets = patch.is_triangle ? 1 : std::min(limits.facets_a_side, count);
    return (count + facets - 1) / facets;
  };
  Patch row{};
  row.origin = narrow(patch.origin);
  row.edge_s = narrow(patch.edge_s);
  row.edge_t = narrow(patch.edge_t);
  row.dual_s = narrow(cross(patch.edge_t, across) / area_sq);
  row.dual_t = narrow(cross(across, patch.edge_s) / area_sq);
  row.ng = narrow(across / area);
  row.cells_per_s = float(s.per_unit);
  row.offset_s = float(s.offset);
  row.cells_per_t = float(t.per_unit);
  row.offset_t = float(t.offset);
  row.per_area = float(1 / area);
  row.is_triangle = patch.is_triangle ? 1 : 0;
  row.uv = {float(patch.uv.x), float(patch.uv.y)};
  row.uv_s = {float(patch.uv_s.x), float(patch.uv_s.y)};
  row.uv_t = {float(patch.uv_t.x), float(patch.uv_t.y)};
  row.cells_s = s.count;
  row.cells_t = t.count;
  row.first_height = -1;
  row.first_facet = facet_count();
  row.cells_a_facet_s = a_facet(s.count);
  row.cells_a_facet_t = a_facet(t.count);
  row.facets_s = (s.count + row.cells_a_facet_s - 1) / row.cells_a_facet_s;
  if (builder.is_linear()) {
    row.first_height = std::int32_t(heights_.size());
    for (int j = 0; j <= t.count; ++j)
      for (int i = 0; i <= s.count; ++i)
        heights_.push_back(float(builder.luminance_at(s.begin(i), t.begin(j))));
  }
  for (int first_t = 0; first_t < t.count; first_t += row.cells_a_facet_t)
    for (int first_s = 0; first_s < s.count; first_s += row.cells_a_facet_s) {
      const int columns = std::min(row.cells_a_facet_s, s.count - first_s),
                rows = std::min(row.cells_a_facet_t, t.count - first_t);
      const auto row_shares_before = std::int32_t(row_shares_.size()),
                 column_shares_before = std::int32_t(column_shares_.size());
      std::vector<double> of_rows;
      double integral = 0, area_st = 0, of_squares = 0;
      for (int j = 0; j < rows; ++j) {
        std::vector<double> of_cells;
        for (int i = 0; i < columns; ++i) {
          const Builder::Weights cell = builder.cell(first_s + i, first_t + j);
          of_cells.push_back(cell.followed);
          integral += cell.integral;
          area_st += cell.area;
          if (cell.area > 0) of_squares += cell.followed * cell.followed / cell.area;
        }
        of_rows.push_back(std::accumulate(of_cells.begin(), of_cells.end(), 0.0));
        append_positive_shares(std::move(of_cells), column_shares_);
      }
      const double followed = std::accumulate(of_rows.begin(), of_rows.end(), 0.0);
      facets_.push_back({patch_count(), first_s, first_t, columns, rows, row_shares_before,
                         column_shares_before,
                         of_squares > 0 ? float(followed * followed / (of_squares * area_st)) : 1});
      weights_.push_back(followed * area);
      integrals_.push_back(integral * area);
      append_positive_shares(std::move(of_rows), row_shares_);
      most_rows_ = std::max(most_rows_, std::int32_t(rows));
      most_columns_ = std::max(most_columns_, std::int32_t(columns));
    }
  patches_.push_back(row);
}

double TexelTable::area(std::int32_t patch) const {
  const Patch& p = patches_[std::size_t(patch)];
  return (p.is_triangle ? 0.5 : 1) / double(p.per_area);
}

std::vector<Vec3f> TexelTable::corners(std::int32_t facet) const {
  const Facet& f = facets_[std::size_t(facet)];
  const Patch& patch = patches_[std::size_t(f.patch)];
  const auto place = [&](float s, float t) { return patch.origin + patch.edge_s * s + patch.edge_t * t; };
  if (patch.is_triangle) return {place(0, 0), place(1, 0), place(0, 1)};
  const auto begin = [](std::int32_t k, float per_unit, float offset, std::int32_t count) {
    return k == 0 ? 0 : k >= count ? 1 : (float(k) - offset) / per_unit;
  };
  const auto s = [&](std::int32_t k) { return begin(k, patch.cells_per_s, patch.offset_s, patch.cells_s); };
  const auto t = [&](std::int32_t k) { return begin(k, patch.cells_per_t, patch.offset_t, patch.cells_t); };
  const float s0 = s(f.first_s), s1 = s(f.first_s + f.cells_s), t0 = t(f.first_t),
              t1 = t(f.first_t + f.cells_t);
  return {place(s0, t0), place(s1, t0), place(s1, t1), place(s0, t1)};
}

}  // namespace etendue

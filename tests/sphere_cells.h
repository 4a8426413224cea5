// Cells of the sphere of directions, and what a density puts into each.
#pragma once

#include "base/vec.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace etendue {

/// A grid over the whole sphere, even in phi and in h(cos theta), which rises from 0 at -1 to the number of
/// rows at 1.
template <class H, class InverseH>
class SphereCells {
 public:
  SphereCells(int rows, int columns, H h, InverseH inverse_h)
      : rows_(rows), columns_(columns), h_(h), inverse_h_(inverse_h) {}

  std::size_t size() const { return std::size_t(rows_ * columns_); }

  std::size_t cell_of(const Vec3<double>& direction) const {
    const double z = std::clamp(direction.z / length(direction), -1.0, 1.0);
    const double across = h_(z) / rows_;
    const double turn = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi);
    const int row = std::clamp(int(across * rows_), 0, rows_ - 1);
    const int column = std::clamp(int((turn < 0 ? turn + 1 : turn) * columns_), 0, columns_ - 1);
    return std::size_t(row * columns_ + column);
  }

  /// The integral of `pdf` (1/sr) over each cell: `steps` x `steps` parts, each by Gauss's rule of 2 x 2
  /// points.
  template <class Pdf>
  std::vector<double> integrals(const Pdf& pdf, int steps) const {
    constexpr double gauss[]{0.21132486540518712, 0.78867513459481288};
    std::vector<double> result(size());
    for (int row = 0; row < rows_; ++row) {
      const double bottom = inverse_h_(row), top = inverse_h_(row + 1);
      const double area = (top - bottom) / steps * 2 * std::numbers::pi / (columns_ * steps);
      for (int i = 0; i < 2 * steps; ++i) {
        const double z = bottom + (top - bottom) * (i / 2 + gauss[i % 2]) / steps;
        const double radius = std::sqrt(std::max(0.0, 1 - z * z));
        for (int k = 0; k < 2 * columns_ * steps; ++k) {
          const double phi = 2 * std::numbers::pi * (k / 2 + gauss[k % 2]) / (columns_ * steps);
          result[std::size_t(row * columns_ + k / (2 * steps))] +=
              0.25 * area * pdf(Vec3<double>{radius * std::cos(phi), radius * std::sin(phi), z});
        }
      }
    }
    return result;
  }

 private:
  int rows_, columns_;
  H h_;
  InverseH inverse_h_;
};

/// A frame about a unit axis, in double.
struct WideFrame {
  Vec3<double> s, t, n;
  explicit WideFrame(const Vec3<double>& axis) : n(axis) {
    s = normalize(cross(std::abs(n.x) < 0.5 ? Vec3<double>{1, 0, 0} : Vec3<double>{0, 1, 0}, n));
    t = cross(n, s);
  }
  Vec3<double> local_from_world(const Vec3<double>& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3<double> world_from_local(const Vec3<double>& v) const { return s * v.x + t * v.y + n * v.z; }
};

/// Nori's cells: even in cos theta and phi.
inline auto even_cells(int rows = 10, int columns = 20) {
  return SphereCells(
      rows, columns, [=](double z) { return (z + 1) / 2 * rows; },
      [=](double h) { return 2 * h / rows - 1; });
}

/// Narrow cells about the axis, for a lobe cos^exponent: 10 rows with a tenth of it each, and 5 for what is
/// outside of it (but for 1e-7).
inline auto lobe_cells(double exponent, int columns = 20) {
  constexpr int lobe_rows = 10, outer_rows = 5;
  const double edge = 1e-7, edge_z = std::pow(edge, 1 / (exponent + 1));
  return SphereCells(
      lobe_rows + outer_rows, columns,
      [=](double z) {
        if (z < edge_z) return (z + 1) / (edge_z + 1) * outer_rows;
        return outer_rows + (std::pow(z, exponent + 1) - edge) / (1 - edge) * lobe_rows;
      },
      [=](double h) {
        if (h <= outer_rows) return h / outer_rows * (edge_z + 1) - 1;
        return std::pow(edge + (h - outer_rows) / lobe_rows * (1 - edge), 1 / (exponent + 1));
      });
}

}  // namespace etendue

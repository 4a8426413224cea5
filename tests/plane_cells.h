// Cells of a plane polygon, and what a measure of directions puts into each.
#pragma once

#include "polygon_outline.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace etendue {

/// A grid over the box of a polygon in its plane.
class PlaneCells {
 public:
  /// \param pilot points of the polygon, from the receiver: lines lie at their quantiles; none: evenly
  explicit PlaneCells(const Outline& outline, const Outline& pilot = {}) : outline_(outline) {
    ng_ = {0, 0, 0};
    for (std::size_t k = 2; k < outline.size(); ++k)
      ng_ = ng_ + cross(outline[k - 1] - outline[0], outline[k] - outline[0]);
    ng_ = normalize(ng_);
    axes_[0] = normalize(outline[1] - outline[0]);
    axes_[1] = cross(ng_, axes_[0]);
    for (std::size_t i = 0; i < 2; ++i)
      for (const Vec3l& corner : outline) {
        low_[i] = std::min(low_[i], dot(corner, axes_[i]));
        high_[i] = std::max(high_[i], dot(corner, axes_[i]));
      }
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<long double> places;
      for (const Vec3l& point : pilot) places.push_back(dot(point, axes_[i]));
      std::sort(places.begin(), places.end());
      for (std::size_t k = 1; k < side; ++k)
        lines_[i].push_back(places.empty() ? low_[i] + (high_[i] - low_[i]) * (long double)k / side
                                           : places[k * places.size() / side]);
    }
  }

  std::size_t cell_of(const Vec3l& direction) const {
    const Vec3l p = direction * (dot(outline_[0], ng_) / dot(direction, ng_));
    std::size_t cell = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto above = std::upper_bound(lines_[i].begin(), lines_[i].end(), dot(p, axes_[i]));
      cell = cell * side + std::size_t(above - lines_[i].begin());
    }
    return cell;
  }

  /// \param measure of an outline
  template <class Measure>
  std::vector<double> shares(const Measure& measure) const {
    std::vector<double> all;
    const long double total = measure(outline_);
    for (std::size_t i = 0; i < side; ++i)
      for (std::size_t j = 0; j < side; ++j) {
        const Outline part = clipped(strip(outline_, 0, i), axes_[1], edge(1, j));
        all.push_back(double(measure(clipped(part, -axes_[1], -edge(1, j + 1))) / total));
      }
    return all;
  }

 private:
  static constexpr std::size_t side = 8;

  long double edge(std::size_t axis, std::size_t k) const {
    // The outermost cells take what rounding has moved out.
    constexpr long double out = 1e-3L;
    if (k == 0) return low_[axis] - out * (high_[axis] - low_[axis]);
    if (k == side) return high_[axis] + out * (high_[axis] - low_[axis]);
    return lines_[axis][k - 1];
  }
  Outline strip(const Outline& outline, std::size_t axis, std::size_t k) const {
    return clipped(clipped(outline, axes_[axis], edge(axis, k)), -axes_[axis], -edge(axis, k + 1));
  }

  Outline outline_;
  Vec3l ng_, axes_[2];
  long double low_[2] = {std::numeric_limits<long double>::max(), std::numeric_limits<long double>::max()};
  long double high_[2] = {std::numeric_limits<long double>::lowest(),
                          std::numeric_limits<long double>::lowest()};
  std::vector<long double> lines_[2];  ///< Between cells.
};

}  // namespace etendue

// A convex polygon as a receiver sees it: a fan of triangles around its first corner.
#pragma once

#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "geometry/box.h"
#include "geometry/clearance.h"
#include "geometry/convex_pieces.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Lanes of polygons with different numbers of corners. Sides from the first corner and areas come from the
/// polygon alone, in double precision: far and thin polygons keep what the corners' differences would lose.
template <class F>
struct PolygonFan {
  Vec3<F> apex;                                 ///< The first corner, from the receiver (m).
  std::array<Vec3<F>, most_corners> from_apex;  ///< Of each corner, from the first (m).
  std::array<F, most_corners> twice_area;       ///< Of the triangle (0, k - 1, k), m^2; k from 2 on.
  Vec3<F> ng;                                   ///< Unit, of the side that shines at the receiver.
  /// Of the receiver above the polygon's plane (m), > 0 where a side that shines faces it; 0 where rounding
  /// cannot tell.
  F height;
  F area;             ///< m^2
  Mask<F> is_turned;  ///< The receiver is behind a polygon that shines from there too.
  Int<F> corners;
  int most;  ///< The greatest of `corners` among the lanes that ask.
};

/// Polygons in memory, by row.
class PolygonTable {
 public:
  /// \param corners 3 to most_corners, convex, in one plane, with an area; seen from the front they turn to
  /// the left \return the row
  std::int32_t add(std::span<const Vec3f> corners) {
    const Vec3<double> apex = widen(corners.front());
    first_.push_back(std::int32_t(corners_.size()));
    corners_.insert(corners_.end(), {corners[0].x, corners[0].y, corners[0].z, 0});
    Vec3<double> sum{0, 0, 0}, before{0, 0, 0};
    for (const Vec3f& corner : corners.subspan(1)) {
      const Vec3<double> side = widen(corner) - apex, across = cross(before, side);
      corners_.insert(corners_.end(), {float(side.x), float(side.y), float(side.z), float(length(across))});
      sum = sum + across;
      before = side;
    }
    const Vec3<double> ng = normalize(sum);
    corners_[std::size_t(first_[count_.size()]) + 3] = float(0.5 * length(sum));
    normals_.insert(normals_.end(), {float(ng.x), float(ng.y), float(ng.z)});
    count_.push_back(std::int32_t(corners.size()));
    return count_.size() - 1;
  }

  /// \param position of the receiver (world, m) \param lanes that ask; the others may hold any row
  template <class F>
  PolygonFan<F> seen_from(const Vec3<F>& position, const Int<F>& row, const Mask<F>& lanes,
                          const Mask<F>& is_twosided = F(0) > F(1)) const {
    const Int<F> safe = select(lanes, row, Int<F>(0));
    const Int<F> at = first_.at(safe);
    // Packets often aim at one polygon, and a gather takes as long as a dozen additions.
    const std::int32_t first_row = first_lane(safe);
    const bool is_one = all(mask_or(equal(safe, Int<F>(first_row)), mask_not(lanes)));
    const float* one = corners_.data() + first_[first_row];
    const auto number = [&](int column, const Int<F>& there) {
      return is_one ? F(one[column]) : gather(corners_.data(), there);
    };
    const auto place = [&](int column, const Int<F>& there) {
      return Vec3<F>{number(column, there), number(column + 1, there + Int<F>(1)),
                     number(column + 2, there + Int<F>(2))};
    };
    const Vec3<F> origin = place(0, at);
    PolygonFan<F> fan;
    fan.apex = origin - position;
    fan.area = number(3, at + Int<F>(3));
    fan.corners = count_.at(safe);
    fan.most = 3;
    while (fan.most < most_corners && any(mask_and(lanes, less(Int<F>(fan.most), fan.corners)))) ++fan.most;
    for (int k = 1; k < fan.most; ++k) {
      const auto n = std::size_t(k);
      const Mask<F> is_corner = less(Int<F>(k), fan.corners);
      const Int<F> there = at + select(is_corner, Int<F>(4 * k), Int<F>(4));
      fan.from_apex[n] = place(4 * k, there);
      fan.twice_area[n] = select(is_corner, number(4 * k + 3, there + Int<F>(3)), F(0));
    }
    const float* normal = normals_.data() + 3 * first_row;
    fan.ng = is_one ? Vec3<F>{F(normal[0]), F(normal[1]), F(normal[2])}
                    : gather_vec3<F>(normals_.data(), safe * Int<F>(3));
    const F height = -dot(fan.ng, fan.apex);
    const F rounding = F(0.25f) * clearance<F>(fan.ng, abs_each(origin) + abs_each(position), F(0));
    fan.is_turned = mask_and(is_twosided, height < F(0));
    fan.height = select(abs(height) > rounding, select(fan.is_turned, -height, height), F(0));
    fan.ng = select(fan.is_turned, -fan.ng, fan.ng);
    return fan;
  }

  double area(std::int32_t row) const { return corners_[std::size_t(first_[row]) + 3]; }  ///< m^2
  Vec3f ng(std::int32_t row) const {
    const float* n = normals_.data() + 3 * std::size_t(row);
    return {n[0], n[1], n[2]};
  }
  /// Around all corners (m).
  Box box(std::int32_t row) const {
    const float* corner = corners_.data() + first_[row];
    const Vec3f apex{corner[0], corner[1], corner[2]};
    Box box;
    box.include(apex);
    for (int k = 1; k < count_[row]; ++k)
      box.include(apex + Vec3f{corner[4 * k], corner[4 * k + 1], corner[4 * k + 2]});
    return box;
  }
  template <class F>
  F area_at(const Int<F>& row) const {
    return gather(corners_.data() + 3, first_.at(row));
  }

  std::int32_t count() const { return count_.size(); }

 private:
  LookupTable<std::int32_t> first_,
      count_;                   ///< Of each polygon: its corners in `corners_`, and their number.
  std::vector<float> normals_;  ///< 3 a polygon.
  /// Of each polygon its first corner (m) and its area (m^2), then of each corner the way there from the
  /// first (m) and twice the area of its triangle (m^2).
  std::vector<float> corners_;
};

}  // namespace etendue

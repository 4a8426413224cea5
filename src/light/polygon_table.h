// Convex polygons in memory, as packets of receivers ask for them.
#pragma once

#include "base/gather.h"
#include "geometry/box.h"
#include "geometry/clearance.h"
#include "light/polygon_fan.h"
#include "light/technique.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

/// Polygons in memory, by row.
class PolygonTable {
 public:
  /// \param corners 3 to most_corners, convex, in one plane, with an area; seen from the front they turn to
  /// the left \return the row
  std::int32_t add(std::span<const Vec3f> corners);
  void set_label(std::int32_t row, std::int32_t label) { records_[std::size_t(row)].label = label; }

  /// \param position of the receiver (world, m) \param lanes that ask; the others may hold any row
  template <class F>
  PolygonFan<F> seen_from(const Vec3<F>& position, const Int<F>& row, const Mask<F>& lanes,
                          const Mask<F>& is_twosided = F(0) > F(1)) const {
    const Int<F> safe = select(lanes, row, Int<F>(0));
    // Packets often aim at one polygon.
    const std::int32_t first_row = first_lane(safe);
    const bool is_one = all(mask_or(equal(safe, Int<F>(first_row)), mask_not(lanes)));
    const auto numbers = [&](const auto* first, const Int<F>& at, std::int32_t first_at, int column) {
      const float* base = reinterpret_cast<const float*>(first) + column;
      if (!is_one) return gather_four(base, at);
      const float* one = base + first_at;
      return std::array<F, 4>{F(one[0]), F(one[1]), F(one[2]), F(one[3])};
    };
    const auto place = [](const std::array<F, 4>& n) { return Vec3<F>{n[0], n[1], n[2]}; };
    const Int<F> at = safe * Int<F>(record_words);
    const auto column = [&](int k) { return numbers(records_.data(), at, first_row * record_words, k); };
    const std::array<F, 4> first = column(0), second = column(4), third = column(8), last = column(12);
    PolygonFan<F> fan;
    const Vec3<F> origin = place(first);
    fan.apex = origin - position;
    fan.area = first[3];
    fan.from_apex[1] = place(second);
    fan.from_apex[2] = place(third);
    fan.twice_area[1] = F(0);
    fan.twice_area[2] = second[3];
    fan.ng = place(last);
    fan.label = as_int(float_as_bits(last[3]));
    const Int<F> packed = as_int(float_as_bits(third[3]));
    fan.corners = packed & Int<F>(0xf);
    fan.most = 3;
    while (fan.most < most_corners && any(mask_and(lanes, less(Int<F>(fan.most), fan.corners)))) ++fan.most;
    const Int<F> further = (packed >> 4) * Int<F>(side_words);
    const std::int32_t first_further = first_lane(packed >> 4) * side_words;
    for (int k = 3; k < fan.most; ++k) {
      const auto n = std::size_t(k);
      const Mask<F> is_corner = less(Int<F>(k), fan.corners);
      const Int<F> skipped((k - 3) * side_words);
      const std::array<F, 4> side = numbers(further_.data(), select(is_corner, further + skipped, Int<F>(0)),
                                            first_further + (k - 3) * side_words, 0);
      fan.from_apex[n] = select(is_corner, place(side), fan.from_apex[1]);
      fan.twice_area[n] = select(is_corner, side[3], F(0));
    }
    fan.spread = fan.area;
    if (has_long_) {
      F longest_sq(0);
      for (int k = 1; k < fan.most; ++k)
        longest_sq = max(longest_sq, length_sq(fan.from_apex[std::size_t(k)]));
      fan.spread = spread_of(fan.area, longest_sq);
    }
    const F height = -dot(fan.ng, fan.apex);
    const F rounding = F(0.25f) * clearance<F>(fan.ng, abs_each(origin) + abs_each(position), F(0));
    fan.is_turned = mask_and(is_twosided, height < F(0));
    fan.height = select(abs(height) > rounding, select(fan.is_turned, -height, height), F(0));
    fan.ng = select(fan.is_turned, -fan.ng, fan.ng);
    return fan;
  }

  double area(std::int32_t row) const { return records_[std::size_t(row)].area; }  ///< m^2
  Vec3f ng(std::int32_t row) const { return records_[std::size_t(row)].ng; }
  /// Around all corners (m).
  Box box(std::int32_t row) const {
    const Record& record = records_[std::size_t(row)];
    Box box;
    box.include(record.apex);
    box.include(record.apex + record.first_side);
    box.include(record.apex + record.second_side);
    const auto further = further_.begin() + (record.further_and_corners >> 4);
    for (int k = 3; k < (record.further_and_corners & 0xf); ++k)
      box.include(record.apex + further[k - 3].from_apex);
    return box;
  }
  /// The first corner (m) and the spread (m^2) of triangles and parallelograms, by the longest of their sides
  /// and diagonals.
  template <class F>
  std::pair<Vec3<F>, F> apex_and_spread(const Int<F>& row) const {
    const Int<F> at = row * Int<F>(record_words);
    const std::array<F, 4> first = gather_four(&records_.data()->apex.x, at);
    const Vec3<F> apex{first[0], first[1], first[2]};
    if (!has_long_) return {apex, first[3]};
    const std::array<F, 4> second = gather_four(&records_.data()->first_side.x, at),
                           third = gather_four(&records_.data()->second_side.x, at);
    const Vec3<F> to_second{second[0], second[1], second[2]}, to_third{third[0], third[1], third[2]};
    const F longest_sq = max(max(length_sq(to_second), length_sq(to_third)), length_sq(to_third - to_second));
    return {apex, spread_of(first[3], longest_sq)};
  }
  template <class F>
  F area_at(const Int<F>& row) const {
    return gather(&records_.data()->area, row * Int<F>(record_words));
  }

  std::int32_t count() const { return std::int32_t(records_.size()); }

 private:
  /// One cache line: lanes with polygons of their own wait for memory, not for arithmetic.
  struct alignas(64) Record {
    Vec3f apex;                        ///< The first corner (m).
    float area;                        ///< m^2
    Vec3f first_side;                  ///< From the apex to the next corner (m).
    float twice_first_area;            ///< Of the triangle of both sides (m^2).
    Vec3f second_side;                 ///< To the third corner (m).
    std::int32_t further_and_corners;  ///< Where the other corners begin; in the low 4 bits, how many in all.
    Vec3f ng;
    std::int32_t label = 0;
  };
  struct Side {
    Vec3f from_apex;   ///< m
    float twice_area;  ///< Of its triangle with the corner before (m^2).
  };
  static constexpr std::int32_t record_words = sizeof(Record) / sizeof(float),
                                side_words = sizeof(Side) / sizeof(float);

  std::vector<Record> records_;
  std::vector<Side> further_;  ///< From the fourth corner on.
  bool has_long_ = false;      ///< Some polygon is_long; spares the others the question.
};

}  // namespace etendue

// A tree of boxes over numbered things, to find those that a box meets.
#pragma once

#include "geometry/box.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace etendue {

inline bool do_meet(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/// The boxes in the order of a Morton curve, each eight of them under one, and so on.
class BoxTree {
 public:
  explicit BoxTree(const std::vector<Box>& boxes);

  /// f(number) for each of the boxes, by its number, that meets `box`.
  template <class Function>
  void for_each_meeting(const Box& box, Function&& f) const {
    if (!order_.empty()) descend(levels_.size() - 1, 0, box, f);
  }

 private:
  static constexpr std::size_t fan = 8;

  template <class Function>
  void descend(std::size_t level, std::size_t at, const Box& box, Function&& f) const {
    if (!do_meet(levels_[level][at], box)) return;
    if (level == 0) return f(order_[at]);
    const std::size_t end = std::min((at + 1) * fan, levels_[level - 1].size());
    for (std::size_t child = at * fan; child < end; ++child) descend(level - 1, child, box, f);
  }

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Box>> levels_;  ///< From the boxes themselves up to one around all.
};

}  // namespace etendue

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

/// The boxes in the order of a Morton curve, each four of them under one, and so on.
class BoxTree {
 public:
  explicit BoxTree(const std::vector<Box>& boxes);

  /// f(number) for each of the boxes, by its number, that meets `box`.
  template <class Function>
  void for_each_meeting(const Box& box, Function&& f) const {
    if (!order_.empty()) descend(levels_.size() - 1, 0, box, f);
  }

  /// f(a, b) for each two of the boxes, by their numbers, that meet each other.
  template <class Function>
  void for_each_pair(Function&& f) const {
    if (!order_.empty()) within(levels_.size() - 1, 0, f);
  }

 private:
  static constexpr std::size_t fan = 4;

  std::size_t end_of_children(std::size_t level, std::size_t at) const {
    return std::min((at + 1) * fan, levels_[level - 1].size());
  }

  template <class Function>
  void descend(std::size_t level, std::size_t at, const Box& box, Function& f) const {
    if (!do_meet(levels_[level][at], box)) return;
    if (level == 0) return f(order_[at]);
    for (std::size_t child = at * fan; child < end_of_children(level, at); ++child)
      descend(level - 1, child, box, f);
  }

  template <class Function>
  void within(std::size_t level, std::size_t at, Function& f) const {
    if (level == 0) return;
    const std::size_t end = end_of_children(level, at);
    for (std::size_t a = at * fan; a < end; ++a) {
      within(level - 1, a, f);
      for (std::size_t b = a + 1; b < end; ++b) between(level - 1, a, b, f);
    }
  }

  template <class Function>
  void between(std::size_t level, std::size_t a, std::size_t b, Function& f) const {
    if (!do_meet(levels_[level][a], levels_[level][b])) return;
    if (level == 0) return f(order_[a], order_[b]);
    for (std::size_t i = a * fan; i < end_of_children(level, a); ++i) {
      if (!do_meet(levels_[level - 1][i], levels_[level][b])) continue;
      for (std::size_t k = b * fan; k < end_of_children(level, b); ++k) between(level - 1, i, k, f);
    }
  }

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Box>> levels_;  ///< From the boxes themselves up to one around all.
};

}  // namespace etendue

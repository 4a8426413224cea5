#include "lint/box_tree.h"

#include <algorithm>

namespace etendue {

namespace {

/// Ten bits with two zeros after each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

std::uint32_t morton_code(const Box& box, const Box& all) {
  const auto cell = [](float low, float high, float from, float to) {
    const float width = to - from;
    const float at = width > 0 ? (0.5f * (low + high) - from) / width * 1023 : 0;
    return std::uint32_t(std::clamp(at, 0.0f, 1023.0f));
  };
  return spread(cell(box.low.x, box.high.x, all.low.x, all.high.x)) |
         spread(cell(box.low.y, box.high.y, all.low.y, all.high.y)) << 1 |
         spread(cell(box.low.z, box.high.z, all.low.z, all.high.z)) << 2;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  Box all;
  for (const Box& box : boxes) {
    all.include(box.low);
    all.include(box.high);
  }
  std::vector<std::uint64_t> keys;
  keys.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    keys.push_back(std::uint64_t(morton_code(boxes[i], all)) << 32 | i);
  std::sort(keys.begin(), keys.end());
  levels_.emplace_back();
  for (const std::uint64_t key : keys) {
    order_.push_back(std::uint32_t(key));
    levels_.back().push_back(boxes[order_.back()]);
  }
  while (levels_.back().size() > 1) {
    const std::vector<Box>& below = levels_.back();
    std::vector<Box> above((below.size() + fan - 1) / fan);
    for (std::size_t i = 0; i < below.size(); ++i) {
      above[i / fan].include(below[i].low);
      above[i / fan].include(below[i].high);
    }
    levels_.push_back(std::move(above));
  }
}

}  // namespace etendue

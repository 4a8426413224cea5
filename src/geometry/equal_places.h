// Vertices at the same place, of a mesh that has several there.
#pragma once

#include "base/vec.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Of each vertex in use the least number of those at the same place.
class EqualPlaces {
 public:
  EqualPlaces(std::span<const Vec3f> positions, std::span<const std::int32_t> indices) {
    const auto [least, greatest] = std::minmax_element(indices.begin(), indices.end());
    first_ = *least;
    const std::size_t count = std::size_t(*greatest - *least) + 1;
    first_at_place_.assign(count, -1);
    const std::size_t slots = std::bit_ceil(2 * count);
    std::vector<std::int32_t> table(slots, -1);
    for (std::size_t v = 0; v < count; ++v) {
      const Vec3f& p = positions[std::size_t(first_) + v];
      std::size_t slot = hash(p) & (slots - 1);
      while (table[slot] >= 0 && !(positions[std::size_t(first_ + table[slot])] == p))
        slot = (slot + 1) & (slots - 1);
      if (table[slot] < 0) table[slot] = std::int32_t(v);
      first_at_place_[v] = table[slot];
    }
  }
  std::int32_t operator()(std::int32_t vertex) const {
    return first_ + first_at_place_[std::size_t(vertex - first_)];
  }
  std::int32_t first() const { return first_; }
  std::size_t count() const { return first_at_place_.size(); }

 private:
  static std::size_t hash(const Vec3f& p) {
    std::uint64_t h = 0;
    for (const float x : {p.x, p.y, p.z}) {
      h = (h ^ std::bit_cast<std::uint32_t>(x + 0.0f)) * 0x9e3779b97f4a7c15u;  // -0 is 0
      h ^= h >> 29;
    }
    return std::size_t(h);
  }
  std::int32_t first_ = 0;
  std::vector<std::int32_t> first_at_place_;
};

}  // namespace etendue

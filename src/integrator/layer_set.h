// How an image is divided into layers, by what its contributions are.
#pragma once

#include "base/lookup_table.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// A way to find light.
///   light: by a sample of the lights. bsdf: by a ray along a direction from the BSDF, or from the camera.
enum class Technique { light, bsdf };

/// One way to divide an image: each contribution belongs to one layer or to none. The layer of part l of the
/// lights and part p of the paths has the number l * path_parts + p.
struct LayerSet {
  static constexpr std::int32_t none = -1;

  std::int32_t light_parts = 1, path_parts = 1;
  LookupTable<std::int32_t> light_part;  ///< By a light's id, or `none`; empty: all lights are part 0.
  /// By technique, and then by depth (the vertices that scattered it; the last stands for all beyond), or
  /// `none`.
  std::array<std::vector<std::int32_t>, 2> path_part{{{0}, {0}}};

  std::size_t count() const { return std::size_t(light_parts) * std::size_t(path_parts); }
  std::int32_t part_of_path(Technique technique, int depth) const {
    const std::vector<std::int32_t>& by_depth = path_part[std::size_t(technique)];
    return by_depth[std::min(std::size_t(depth), by_depth.size() - 1)];
  }
};

/// Of all layers of some sets.
inline std::size_t layer_count(std::span<const LayerSet> sets) {
  std::size_t count = 0;
  for (const LayerSet& set : sets) count += set.count();
  return count;
}

}  // namespace etendue

// Which contributions a layer of the image collects.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace etendue {

/// A way to find light.
///   light: by a sample of the lights. bsdf: by a ray along a direction from the BSDF, or from the camera.
enum class Technique { light, bsdf };

/// Those that meet all that is stated.
struct LayerRule {
  std::optional<std::int32_t> light;  ///< Its id.
  std::optional<Technique> technique;
  int least_depth = 0, most_depth = std::numeric_limits<int>::max();  ///< Vertices that scattered it.
};

}  // namespace etendue

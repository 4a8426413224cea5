// The pixels in which a lamp's image may end: the light that the camera sees of it is noisy there.
#pragma once

#include "film/filter.h"
#include "geometry/camera.h"
#include "geometry/geometry.h"
#include "light/light.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Pixels whose filter reaches an outline of a shape that shines, as the camera sees it: where one of its
/// surfaces ends, turns away, or is cut by a clip plane. Conservative, but for what the limit of work leaves
/// out; other shapes are not looked at, neither those that hide an outline nor those that hide a part of a
/// lamp. It decides how many rays look for lamps, never what a pixel is worth.
class LampOutlines {
 public:
  /// None.
  LampOutlines() = default;
  /// None where the filter has negative lobes, as each ray would need a weight of its own.
  LampOutlines(const Camera& camera, const PixelFilter& filter, const Geometry& geometry,
               const Lights& lights);

  bool is_empty() const { return is_at_outline_.empty(); }
  /// Whether the pixel is one of them; it must be of the camera's image.
  bool contains(int x, int y) const {
    return !is_empty() && is_at_outline_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] != 0;
  }
  std::int64_t pixel_count() const;

 private:
  int width_ = 0;
  std::vector<std::uint8_t> is_at_outline_;  ///< By pixel, row after row; empty where none is.
};

}  // namespace etendue

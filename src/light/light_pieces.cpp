#include "light/light_pieces.h"

#include "light/light_point.h"

#include <algorithm>
#include <array>

namespace etendue {

namespace {

/// The cell of a 4x4 grid over the two longest sides of the mesh's box that holds a triangle's centre, in
/// Morton order: where a light has many triangles, these are its pieces.
class PieceGrid {
 public:
  explicit PieceGrid(const std::vector<Vec3f>& centers) {
    Vec3f low = centers.front(), high = low;
    for (const Vec3f& c : centers) {
      low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
      high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
    }
    low_ = {low.x, low.y, low.z};
    size_ = {high.x - low.x, high.y - low.y, high.z - low.z};
    const auto shortest = std::min_element(size_.begin(), size_.end()) - size_.begin();
    first_axis_ = shortest == 0 ? 1 : 0;
    second_axis_ = shortest == 2 ? 1 : 2;
  }

  std::int32_t piece(const Vec3f& center) const {
    const std::array c{center.x, center.y, center.z};
    const auto cell = [&](std::size_t axis) {
      return size_[axis] > 0 ? std::min(std::int32_t(4 * (c[axis] - low_[axis]) / size_[axis]), 3) : 0;
    };
    const std::int32_t x = cell(first_axis_), y = cell(second_axis_);
    return (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
  }

 private:
  std::array<float, 3> low_{}, size_{};
  std::size_t first_axis_, second_axis_;
};

}  // namespace

std::vector<std::int32_t> pieces_of(const std::vector<Vec3f>& centers) {
  const PieceGrid grid(centers);
  const std::size_t count = centers.size();
  std::vector<std::int32_t> pieces;
  for (std::size_t k = 0; k < count; ++k) {
    // Of a light with few parts, each has several pieces.
    const auto begin = std::int32_t(k * light_pieces / count),
               end = std::int32_t((k + 1) * light_pieces / count);
    pieces.push_back(count >= light_pieces ? grid.piece(centers[k]) | 1 << 8 : begin | (end - begin) << 8);
  }
  return pieces;
}

}  // namespace etendue

#include "render/work_unit.h"

#include <algorithm>

namespace etendue {

namespace {

int tile_side_px(const WorkUnit& whole, int threads) {
  constexpr int largest = 32, smallest = 4, tiles_a_thread = 8;
  constexpr double most_samples = 4e6;
  int side = largest;
  const auto is_coarse = [&] {
    const double tile = double(side) * side;
    return double(whole.pixels.width()) * whole.pixels.height() < tile * threads * tiles_a_thread ||
           tile * double(whole.samples_per_pixel()) > most_samples;
  };
  while (side > smallest && is_coarse()) side /= 2;
  return side;
}

}  // namespace

std::vector<WorkUnit> tiles_of(const WorkUnit& whole, int threads) {
  const int side = tile_side_px(whole, threads);
  const PixelRectangle& all = whole.pixels;
  std::vector<WorkUnit> tiles;
  for (int y = all.y_begin; y < all.y_end; y += side)
    for (int x = all.x_begin; x < all.x_end; x += side) {
      tiles.push_back(whole);
      tiles.back().pixels = {x, y, std::min(x + side, all.x_end), std::min(y + side, all.y_end)};
    }
  return tiles;
}

}  // namespace etendue

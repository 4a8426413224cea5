#include "render/work_unit.h"

#include <algorithm>
#include <bit>

namespace etendue {

namespace {

constexpr int largest_side_px = 32, smallest_side_px = 4, tiles_a_thread = 8;
constexpr std::int64_t most_samples_of_tile = 4'000'000;

/// Adds `tile`, or its quarters where it is large.
void add_in_parts(const WorkUnit& tile, std::int64_t most, std::vector<WorkUnit>& tiles) {
  const PixelRectangle& all = tile.pixels;
  const int side = std::max(all.width(), all.height());
  if (side <= smallest_side_px || tile.samples() <= most) return tiles.push_back(tile);
  const int half = int(std::bit_ceil(unsigned(side))) / 2;
  const int x_middle = std::min(all.x_begin + half, all.x_end),
            y_middle = std::min(all.y_begin + half, all.y_end);
  for (const PixelRectangle& part : {PixelRectangle{all.x_begin, all.y_begin, x_middle, y_middle},
                                     PixelRectangle{x_middle, all.y_begin, all.x_end, y_middle},
                                     PixelRectangle{all.x_begin, y_middle, x_middle, all.y_end},
                                     PixelRectangle{x_middle, y_middle, all.x_end, all.y_end}}) {
    if (part.width() == 0 || part.height() == 0) continue;
    WorkUnit quarter = tile;
    quarter.pixels = part;
    add_in_parts(quarter, most, tiles);
  }
}

}  // namespace

std::int64_t WorkUnit::samples() const {
  if (!allocation) return std::int64_t(pixels.width()) * pixels.height() * replicates * samples_per_replicate;
  std::int64_t sum = 0;
  for (int y = pixels.y_begin; y < pixels.y_end; ++y)
    for (int x = pixels.x_begin; x < pixels.x_end; ++x) sum += allocation->at(x, y);
  return sum * replicates;
}

std::vector<WorkUnit> tiles_of(const WorkUnit& whole, int threads) {
  const PixelRectangle& all = whole.pixels;
  const std::int64_t most =
      std::min(most_samples_of_tile, whole.samples() / (std::int64_t(threads) * tiles_a_thread) + 1);
  std::vector<WorkUnit> tiles;
  for (int y = all.y_begin; y < all.y_end; y += largest_side_px)
    for (int x = all.x_begin; x < all.x_end; x += largest_side_px) {
      WorkUnit tile = whole;
      tile.pixels = {x, y, std::min(x + largest_side_px, all.x_end),
                     std::min(y + largest_side_px, all.y_end)};
      add_in_parts(tile, most, tiles);
    }
  return tiles;
}

}  // namespace etendue

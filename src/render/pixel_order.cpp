#include "render/pixel_order.h"

#include <algorithm>

namespace etendue {
namespace {

constexpr int square_px = 32, bits_a_side = 5;

/// Bits 0, 2, 4 ... of a place in the square.
int even_bits(int morton) {
  int result = 0;
  for (int bit = 0; bit < bits_a_side; ++bit) result |= (morton >> (2 * bit) & 1) << bit;
  return result;
}

}  // namespace

std::vector<PixelToRender> pixels_in_order(const WorkUnit& unit) {
  const PixelRectangle& area = unit.pixels;
  std::vector<PixelToRender> pixels;
  pixels.reserve(std::size_t(area.width()) * std::size_t(area.height()));
  for (int y = area.y_begin; y < area.y_end; y += square_px)
    for (int x = area.x_begin; x < area.x_end; x += square_px)
      for (int k = 0; k < square_px * square_px; ++k) {
        const int pixel_x = x + even_bits(k), pixel_y = y + even_bits(k >> 1);
        if (pixel_x < area.x_end && pixel_y < area.y_end)
          pixels.push_back({pixel_x, pixel_y, unit.samples_per_replicate_of(pixel_x, pixel_y)});
      }
  if (unit.allocation) std::ranges::stable_sort(pixels, {}, &PixelToRender::samples_per_replicate);
  return pixels;
}

}  // namespace etendue

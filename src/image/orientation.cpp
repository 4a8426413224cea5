#include "image/orientation.h"

#include <cstdint>
#include <utility>

namespace etendue {

ColorImage upright(ColorImage stored, const Orientation& orientation) {
  if (orientation.is_upright()) return stored;
  ColorImage image = {stored.width, stored.height, std::vector<float>(stored.rgb.size())};
  if (orientation.is_transposed) std::swap(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int row = y, column = x;
      if (orientation.is_transposed) std::swap(row, column);
      if (orientation.has_last_row_first) row = stored.height - 1 - row;
      if (orientation.has_last_column_first) column = stored.width - 1 - column;
      const auto at = [](const ColorImage& of, int i, int j) {
        return 3 * (std::size_t(j) * std::size_t(of.width) + std::size_t(i));
      };
      for (std::size_t k = 0; k < 3; ++k)
        image.rgb[at(image, x, y) + k] = stored.rgb[at(stored, column, row) + k];
    }
  return image;
}

Orientation exif_orientation(std::span<const unsigned char> exif) {
  if (exif.size() < 8) return {};
  const bool is_little = exif[0] == 'I';
  const auto number = [&](std::size_t at, std::size_t size) -> std::uint32_t {  // 0 beyond the end.
    if (at > exif.size() || exif.size() - at < size) return 0;
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < size; ++k)
      value |= std::uint32_t(exif[at + k]) << 8 * (is_little ? k : size - 1 - k);
    return value;
  };
  constexpr std::uint32_t tiff_magic = 42, orientation_tag = 0x0112;
  constexpr std::size_t entry_size = 12;
  if (number(2, 2) != tiff_magic) return {};
  const std::size_t directory = number(4, 4);
  for (std::uint32_t k = 0; k < number(directory, 2); ++k) {
    const std::size_t entry = directory + 2 + entry_size * k;
    if (number(entry, 2) != orientation_tag) continue;
    switch (number(entry + 8, 2)) {  // TIFF 6.0: where the 0th row and the 0th column are.
      case 2:
        return {false, false, true};
      case 3:
        return {false, true, true};
      case 4:
        return {false, true, false};
      case 5:
        return {true, false, false};
      case 6:
        return {true, true, false};
      case 7:
        return {true, true, true};
      case 8:
        return {true, false, true};
      default:
        return {};
    }
  }
  return {};
}

}  // namespace etendue

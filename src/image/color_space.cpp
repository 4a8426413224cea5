#include "image/color_space.h"

#include "image/unreadable.h"

#include <algorithm>

namespace etendue {
namespace {

using ColorVector = std::array<double, 3>;

ColorMatrix product(const ColorMatrix& a, const ColorMatrix& b) {
  ColorMatrix result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
  return result;
}

ColorVector product(const ColorMatrix& a, const ColorVector& b) {
  ColorVector result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i] += a[i][k] * b[k];
  return result;
}

ColorMatrix inverse(const ColorMatrix& m) {
  const auto minor = [&](std::size_t row, std::size_t column) {
    const std::size_t r0 = (row + 1) % 3, r1 = (row + 2) % 3, c0 = (column + 1) % 3, c1 = (column + 2) % 3;
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  if (!(std::abs(determinant) > 1e-6)) throw Unreadable("its primaries lie on a line");
  ColorMatrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = minor(j, i) / determinant;
  return result;
}

ColorMatrix diagonal(const ColorVector& d) { return {{{d[0], 0, 0}, {0, d[1], 0}, {0, 0, d[2]}}}; }

/// Of luminance 1.
ColorVector xyz_of_white(const Vec2<double>& white) {
  if (!(white.y > 0)) throw Unreadable("its white point has no luminance");
  return {white.x / white.y, 1, (1 - white.x - white.y) / white.y};
}

ColorMatrix xyz_from_rgb(const Chromaticities& space) {
  ColorMatrix primaries;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2<double> xy = space.primaries[k];
    primaries[0][k] = xy.x;
    primaries[1][k] = xy.y;
    primaries[2][k] = 1 - xy.x - xy.y;
  }
  return product(primaries, diagonal(product(inverse(primaries), xyz_of_white(space.white))));
}

/// Colours seen under the white `from` as they look under the white `to`.
ColorMatrix adaptation(const Vec2<double>& from, const Vec2<double>& to) {
  constexpr ColorMatrix bradford{
      {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
  const ColorVector cones_from = product(bradford, xyz_of_white(from)),
                    cones_to = product(bradford, xyz_of_white(to));
  ColorVector gain;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(cones_from[k] > 0)) throw Unreadable("its white point is no colour");
    gain[k] = cones_to[k] / cones_from[k];
  }
  return product(inverse(bradford), product(diagonal(gain), bradford));
}

bool is_close(const Vec2<double>& a, const Vec2<double>& b) {
  constexpr double digits = 0.001;
  return std::abs(a.x - b.x) < digits && std::abs(a.y - b.y) < digits;
}

}  // namespace

std::optional<ColorMatrix> rec709_from(const Chromaticities& from) {
  bool is_same = is_close(from.white, rec709.white);
  for (std::size_t k = 0; k < 3; ++k) is_same = is_same && is_close(from.primaries[k], rec709.primaries[k]);
  if (is_same) return std::nullopt;
  return product(inverse(xyz_from_rgb(rec709)),
                 product(adaptation(from.white, rec709.white), xyz_from_rgb(from)));
}

void convert_colors(const ColorMatrix& matrix, std::span<float> rgb) {
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const ColorVector stored{rgb[i], rgb[i + 1], rgb[i + 2]};
    const ColorVector color = product(matrix, stored);
    // What was negative or not a number before must not become a colour.
    const bool is_color = stored[0] >= 0 && stored[1] >= 0 && stored[2] >= 0;
    for (std::size_t k = 0; k < 3; ++k) rgb[i + k] = float(is_color ? std::max(color[k], 0.0) : color[k]);
  }
}

}  // namespace etendue

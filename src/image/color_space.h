// What the numbers of an image file mean as colours, and their way to linear light with Rec. 709 primaries.
#pragma once

#include "base/vec.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace etendue {

/// CIE x, y of the primaries and of white.
struct Chromaticities {
  std::array<Vec2<double>, 3> primaries;
  Vec2<double> white;
};
/// ITU-R BT.709, white D65; sRGB has the same.
inline constexpr Chromaticities rec709{{{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}}}, {0.3127, 0.329}};

/// Rows of a matrix that is applied to a column of three numbers.
using ColorMatrix = std::array<std::array<double, 3>, 3>;

/// Linear Rec. 709 from linear light with the primaries `from`. White stays white: where it is another one,
/// colours are adapted to D65 by the Bradford transform (ICC.1:2022, annex E). None where both are the same
/// but for the digits that files keep. Throws Unreadable where the primaries span no space of colours.
std::optional<ColorMatrix> rec709_from(const Chromaticities& from);

/// Applies `matrix` to each pixel. A colour that Rec. 709 could only have with a negative channel gets 0
/// there.
void convert_colors(const ColorMatrix& matrix, std::span<float> rgb);

/// Linear light from the transfer function of IEC 61966-2-1.
inline double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace etendue

#include "geometry/rounded_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace etendue {
namespace {

/// Of the size of a mesh, from which it is told; as lint does for what reading rounds.
constexpr double rounding_worth_telling = 1e-2;

constexpr std::array axes{&Vec3<double>::x, &Vec3<double>::y, &Vec3<double>::z};

/// Within what decimals lose, a small part of the distance between floats.
bool is_float(double value) {
  const float nearest = float(value);
  const double spacing =
      std::nextafter(std::abs(nearest), std::numeric_limits<float>::infinity()) - std::abs(nearest);
  return std::abs(value - nearest) <= spacing / 32;
}

}  // namespace

std::string float_rounding_in_file(const std::vector<Vec3<double>>& positions) {
  double farthest = 0, size_sq = 0;
  for (const auto axis : axes) {
    const auto [low, high] = std::minmax_element(
        positions.begin(), positions.end(), [&](const auto& a, const auto& b) { return a.*axis < b.*axis; });
    if (low == high) continue;
    farthest = std::max({farthest, std::abs((*low).*axis), std::abs((*high).*axis)});
    const double side = (*high).*axis - (*low).*axis;
    size_sq += side * side;
  }
  const double size = std::sqrt(size_sq), rounding = farthest * 0x1p-24;
  if (!(size > 0) || !(rounding > rounding_worth_telling * size)) return {};
  // Coordinates near 0 say nothing: they are on the finer grid there.
  for (const auto axis : axes)
    for (const Vec3<double>& position : positions)
      if (std::abs(position.*axis) > farthest / 4 && !is_float(position.*axis)) return {};
  return fmt::format(
      "the places in this file are floats {:.2g} from its origin, of a mesh {:.2g} in size: they were "
      "rounded by up to "
      "{:.2g}, {:.2g} % of the size, before they came here",
      farthest, size, rounding, 100 * rounding / size);
}

}  // namespace etendue

// Disks, ellipses and receivers of all the sorts that trouble floats.
#pragma once

#include "geometry/geometry.h"
#include "polygon_outline.h"
#include "random_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace etendue {

struct DiskCase {
  Disk disk;
  Vec3f position, ns;  ///< Of the receiver.

  /// As a polygon of the same area, to 4e-7 of the half axes; turning as polygons do.
  Outline outline() const {
    constexpr int corners = 2048;
    constexpr long double step = 2 * std::numbers::pi_v<long double> / corners;
    const long double size = std::sqrt(step / std::sin(step));
    const Vec3l center = extended(disk.center) - extended(position);
    const bool is_mirrored = dot(cross(disk.along_x, disk.along_y), disk.ng) < 0;
    Outline seen;
    for (int k = 0; k < corners; ++k) {
      const long double turn = (is_mirrored ? -step : step) * k;
      seen.push_back(center + extended(disk.along_x) * (size * std::cos(turn)) +
                     extended(disk.along_y) * (size * std::sin(turn)));
    }
    return seen;
  }

  /// How many times their rounding the places alone change what is seen: how large they are over the
  /// receiver's height above the disk, times what that makes of the shorter half axis.
  double condition() const {
    const Vec3l to_center = extended(disk.center) - extended(position);
    const long double height = std::abs(dot(to_center, extended(disk.ng)));
    const long double places =
        length(extended(disk.center)) + length(to_center) + length(extended(disk.along_x));
    const long double shorter = length(extended(cross(disk.along_x, disk.along_y))) /
                                std::max(length(extended(disk.along_x)), length(extended(disk.along_y)));
    return double((1 + places / height) * (1 + places / shorter));
  }
};

inline constexpr std::array disk_case_kinds{"ordinary", "far",         "touching",
                                            "grazing",  "at the edge", "on the axis"};

/// \param kind of disk_case_kinds
class DiskCases : public RandomCases {
 public:
  using RandomCases::RandomCases;

  DiskCase next(std::size_t kind) {
    const std::string_view name = disk_case_kinds[kind];
    const double size = std::pow(10, 2 * unit() - 1);
    // A third are circles, a third up to a thousand times as long as wide; half of the ellipses are sheared.
    const double shape = unit(), width = shape < 1.0 / 3   ? 1
                                         : shape < 2.0 / 3 ? unit()
                                                           : std::pow(10, -3 * unit());
    const double shear = width < 1 && unit() < 0.5 ? 2 * unit() - 1 : 0;
    const Vec3l ng = direction(), s = normalize(cross(ng, direction())), t = cross(ng, s);
    const auto along = [&](double x, double y, double z) {
      return rounded((s * (long double)x + t * (long double)y + ng * (long double)z) * (long double)size);
    };
    DiskCase made;
    made.disk.center = rounded(direction() * (long double)unit());
    made.disk.along_x = along(1, 0, 0);
    made.disk.along_y = along(shear, width, 0);
    made.disk.ng = rounded(ng);
    made.ns = rounded(direction());
    const double turn = 2 * std::numbers::pi * unit(), cosine = unit(), sine = std::sqrt(1 - cosine * cosine);
    double x = std::cos(turn) * sine, y = std::sin(turn) * sine, z = cosine;
    double distance = std::pow(10, unit() - 0.5);
    if (name == "far") distance = std::pow(10, 1 + 3 * unit());
    if (name == "touching" || name == "at the edge") {
      const double radius = name == "touching" ? std::sqrt(unit()) : 1 + (unit() - 0.5) * 0.01;
      x = radius * std::cos(turn) + shear * radius * std::sin(turn);
      y = width * radius * std::sin(turn);
      z = width * std::pow(10, -2.5 * unit());
      distance = 1;
    }
    if (name == "grazing") z *= std::pow(10, -1 - 2 * unit());
    if (name == "on the axis") x = y = 0;
    made.position = made.disk.center + along(x * distance, y * distance, z * distance);
    return made;
  }
};

}  // namespace etendue

// Convex polygons and receivers of all the sorts that trouble floats, and what receivers see of them, in
// extended precision.
#pragma once

#include "geometry/convex_pieces.h"
#include "polygon_outline.h"
#include "random_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

namespace etendue {

struct PolygonCase {
  std::vector<Vec3f> corners;
  Vec3f position, ns;  ///< Of the receiver.

  Outline outline() const {
    Outline seen;
    for (const Vec3f& corner : corners) seen.push_back(extended(corner) - extended(position));
    return seen;
  }

  /// How many times their rounding the places alone change what is seen: how large they are over the
  /// receiver's height above the polygon's plane, over its distance from a side or diagonal, over the
  /// polygon's width.
  double condition() const {
    const Outline seen = outline();
    Vec3l across{0, 0, 0};
    for (std::size_t k = 2; k < seen.size(); ++k)
      across = across + cross(seen[k - 1] - seen[0], seen[k] - seen[0]);
    const long double height = std::abs(dot(seen[0], across)) / length(across);
    long double places = std::abs(position.x) + std::abs(position.y) + std::abs(position.z);
    long double longest = 0, nearest = length(seen[0]);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      places = std::max(places, length(seen[k]));
      for (const Vec3l& other : {seen[(k + 1) % seen.size()], seen[0]}) {
        const Vec3l side = other - seen[k];
        const long double side_sq = length_sq(side);
        if (!(side_sq > 0)) continue;
        const long double along = std::clamp<long double>(-dot(seen[k], side) / side_sq, 0, 1);
        nearest = std::min(nearest, length(seen[k] + side * along));
        longest = std::max(longest, std::sqrt(side_sq));
      }
    }
    const long double slenderness = longest * longest / length(across);
    return double(1 + (1 + slenderness) * places / height + longest / nearest +
                  slenderness * places / longest);
  }
};

inline constexpr std::array polygon_case_kinds{"ordinary", "far",       "tiny",      "touching", "grazing",
                                               "sliver",   "at a side", "low light", "overhead"};

/// \param kind of polygon_case_kinds. May give a polygon without an area.
class PolygonCases : public RandomCases {
 public:
  using RandomCases::RandomCases;

  PolygonCase next(std::size_t kind) {
    const std::string_view name = polygon_case_kinds[kind];
    const double size = name == "tiny" ? std::pow(10, -4 * unit()) : 1;
    const double width = name == "sliver" ? std::pow(10, -1 - 3 * unit()) : name == "low light" ? 0.05 : 1;
    const Vec3l ng = direction(), s = normalize(cross(ng, direction())), t = cross(ng, s);
    const auto place = [&](double x, double y, double z) {
      const Vec3l p = s * (long double)x + t * (long double)y + ng * (long double)z;
      return Vec3f{float(p.x), float(p.y), float(p.z)};
    };
    std::vector<double> angles(3 + random_() % (most_corners - 2));
    for (double& angle : angles) angle = 2 * std::numbers::pi * unit();
    std::sort(angles.begin(), angles.end());
    PolygonCase made;
    for (const double angle : angles)
      made.corners.push_back(place(size * std::cos(angle), size * width * std::sin(angle), 0));
    made.ns = rounded(direction());

    const double azimuth = 2 * std::numbers::pi * unit(), cosine = unit(),
                 sine = std::sqrt(1 - cosine * cosine);
    double distance = std::pow(10, unit() - 0.7);
    if (name == "far") distance = std::pow(10, 1 + 3 * unit());
    if (name == "tiny") distance = 10;
    if (name == "overhead") distance = std::pow(10, 2 * unit());
    made.position =
        place(distance * sine * std::cos(azimuth), distance * sine * std::sin(azimuth), distance * cosine);
    if (name == "touching")
      made.position = place(0.6 * unit() - 0.3, 0.6 * unit() - 0.3, std::pow(10, -3 * unit()));
    if (name == "grazing")
      made.position = place((1 + distance) * std::cos(azimuth), (1 + distance) * std::sin(azimuth),
                            distance * std::pow(10, -1 - 3 * unit()));
    if (name == "at a side") {
      const Vec3l a = extended(made.corners[0]), side = extended(made.corners[1]) - a;
      const Vec3l out = normalize(cross(side, ng)) * (long double)(unit() < 0.5 ? 1 : -1);
      const long double off = std::pow(10, -3 * unit());
      made.position = rounded(a + side * (long double)unit() + (out + ng) * off);
      if (unit() < 0.5) made.ns = rounded(out);
    }
    const Vec3l to_light =
        normalize(extended(made.corners[0]) + extended(made.corners[1]) - extended(made.position) * 2.0L);
    if (name == "low light")
      made.ns =
          rounded(normalize(normalize(cross(to_light, direction())) + to_light * (0.3L * unit() - 0.1L)));
    if (name == "overhead") made.ns = rounded(normalize(to_light + direction() * 0.02L));
    return made;
  }
};

}  // namespace etendue

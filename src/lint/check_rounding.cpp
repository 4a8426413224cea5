#include "geometry/bounds.h"
#include "lint/checks.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Of what rounding does to a place, the share of a shape's size from which it is told.
constexpr double rounding_worth_a_finding = 1e-2;

}  // namespace

void check_rounding(const LintContext& context, Findings& findings) {
  const Geometry& geometry = context.scene.geometry;
  // What reading the file in double has left of places far from its origin.
  const double in_file = length(context.scene.origin) * 0x1p-53;
  for (std::int32_t id = 0; id < geometry.count(); ++id) {
    const Box box = box_of(geometry, id);
    const double size = length(box.high - box.low);
    const auto farther = [](float a, float b) { return std::max(std::abs(double(a)), std::abs(double(b))); };
    const double farthest = std::max(
        {farther(box.low.x, box.high.x), farther(box.low.y, box.high.y), farther(box.low.z, box.high.z)});
    const double rounding = std::max(farthest * 0x1p-24, in_file);
    if (!(rounding > rounding_worth_a_finding * size)) continue;
    const ScenePlaces::Shape& shape = context.places.shapes[std::size_t(id)];
    findings.add(
        "rounded-place", shape.where,
        fmt::format("the {} is {:.2g} m in size, {:.2g} m from the middle of the scene: its places are "
                    "rounded by up to {:.2g} m, {:.2g} % of its size, and what it casts and catches is "
                    "wrong by about as much",
                    shape.name, size, std::max(farthest, length(context.scene.origin)), rounding,
                    100 * rounding / size),
        "bring the parts of the scene nearer to each other, or render this one in a scene of its own");
  }
}

}  // namespace etendue

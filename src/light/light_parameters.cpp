#include "light/light_parameters.h"

#include "base/reach.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Scene files hold only transforms that can be inverted.
Transform world_from_light(const Parameters& parameters) {
  return parameters.has("toWorld") ? parameters.transform("toWorld") : Transform{};
}

}  // namespace

Transform rotation_from_light(const Parameters& parameters) {
  const Transform given = world_from_light(parameters);
  const Vec3<double> x = transform_vector(given, {1, 0, 0}), y = transform_vector(given, {0, 1, 0}),
                     z = transform_vector(given, {0, 0, 1});
  const double along_x = length(x), along_y = length(y), along_z = length(z);
  const double shear =
      std::max({std::abs(dot(x / along_x, y / along_y)), std::abs(dot(y / along_y, z / along_z)),
                std::abs(dot(z / along_z, x / along_x))});
  if (std::max({along_x, along_y, along_z}) > 1.0001 * std::min({along_x, along_y, along_z}) || shear > 1e-4)
    throw InputError(
        parameters.location("toWorld"),
        fmt::format("this transform is no rotation (it scales the axes by {:.4g}, {:.4g}, {:.4g})", along_x,
                    along_y, along_z),
        "only rotations and mirror images have a meaning for a light at infinity");
  const auto column = [](const Vec3<double>& v) { return v / length(v); };
  const Vec3<double> a = column(x), b = column(y), c = column(z);
  Transform rotation;
  rotation.m = {{{a.x, b.x, c.x, 0}, {a.y, b.y, c.y, 0}, {a.z, b.z, c.z, 0}, {0, 0, 0, 1}}};
  return rotation;
}

Vec3f world_point(const Parameters& parameters, std::string_view name) {
  const Vec3f point = narrow(transform_point(world_from_light(parameters), parameters.point(name)));
  if (!is_within_reach(point))
    throw PlaceError(parameters.location(name), fmt::format("'{}' lies beyond what can be rendered: {} {} {}",
                                                            name, point.x, point.y, point.z));
  return point;
}

Vec3f world_direction(const Parameters& parameters, std::string_view name) {
  const Vec3<double> direction = transform_vector(world_from_light(parameters), parameters.vector(name));
  const double size = length(direction);
  if (!(size > 0) || !std::isfinite(size))
    throw InputError(parameters.location(name),
                     fmt::format("'{}' has no direction that can be computed with", name),
                     "give three numbers that are not all 0");
  return narrow(direction / size);
}

std::string_view stated_one_of(const Parameters& parameters, std::string_view name, std::string_view other) {
  if (parameters.is_stated(name) && parameters.is_stated(other))
    throw InputError(parameters.location(other),
                     fmt::format("both '{}' and '{}' are stated; they say the same thing", name, other),
                     "leave one of them out");
  return parameters.is_stated(other) ? other : name;
}

}  // namespace etendue

#include "medium/homogeneous.h"

#include "base/reach.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue {

namespace {

using Type = Parameter::Type;

const Plugin homogeneous_plugin{
    "medium",
    "homogeneous",
    "A uniform medium that fills the unit cube [0, 1]^3 under toWorld; for the path integrators.",
    {{"sigmaA", Type::color, "0", "1/m", "Absorption coefficient"},
     {"sigmaS", Type::color, "0", "1/m", "Scattering coefficient"},
     {"toWorld", Type::transform, "", "", "World from the unit cube; identity unless given"}},
    {"phase"}};
const Plugin isotropic_plugin{"phase", "isotropic", "Scatters alike in all directions.", {}, {}};
const Plugin hg_plugin{
    "phase",
    "hg",
    "Henyey and Greenstein's phase function.",
    {{"g", Type::real, "0", "", "Mean cosine of the angle of scattering, between -1 and 1; > 0: forwards"}},
    {}};

}  // namespace

const std::vector<Plugin>& medium_plugins() {
  static const std::vector<Plugin> plugins{homogeneous_plugin};
  return plugins;
}

const std::vector<Plugin>& phase_plugins() {
  static const std::vector<Plugin> plugins{isotropic_plugin, hg_plugin};
  return plugins;
}

HenyeyGreenstein make_phase(const Object& description, std::vector<UnreadKey>& unread) {
  if (description.type == isotropic_plugin.name) {
    Parameters(description, isotropic_plugin, unread);
    return {};
  }
  if (description.type != hg_plugin.name) throw unknown_plugin(description, phase_plugins());
  const Parameters parameters(description, hg_plugin, unread);
  const double g = parameters.real("g");
  constexpr double most = 0.99;
  if (!(g >= -most && g <= most))
    throw InputError(parameters.location("g"),
                     fmt::format("'g' is {}; it must be from {} to {}", g, -most, most));
  return {float(g)};
}

HomogeneousMedium::HomogeneousMedium(const Colorf& sigma_a, const Colorf& sigma_s,
                                     const HenyeyGreenstein& phase_function,
                                     const Transform& world_from_medium)
    : phase(phase_function),
      sigma_s_(sigma_s),
      sigma_t_(sigma_a + sigma_s),
      is_scattering_(sigma_s != Colorf{0, 0, 0}),
      is_grey_(sigma_t_.r == sigma_t_.g && sigma_t_.g == sigma_t_.b) {
  const Vec3<double> x = transform_vector(world_from_medium, {1, 0, 0}),
                     y = transform_vector(world_from_medium, {0, 1, 0}),
                     z = transform_vector(world_from_medium, {0, 0, 1}),
                     origin = transform_point(world_from_medium, {0, 0, 0});
  const double volume = dot(cross(x, y), z);
  const std::array rows{cross(y, z) / volume, cross(z, x) / volume, cross(x, y) / volume};
  for (std::size_t i = 0; i < rows.size(); ++i)
    medium_from_world_[i] = {float(rows[i].x), float(rows[i].y), float(rows[i].z),
                             float(-dot(rows[i], origin))};
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vec3<double> corner =
        transform_point(world_from_medium, {i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
    corners_[i] = {float(corner.x), float(corner.y), float(corner.z)};
  }
}

Sphere HomogeneousMedium::bounds_with(const Sphere& shapes) const {
  Sphere bounds = shapes;
  for (const Vec3f& corner : corners_)
    bounds.radius = std::max(bounds.radius, length(corner - shapes.center));
  return bounds;
}

HomogeneousMedium make_medium(const Object& description, std::vector<UnreadKey>& unread) {
  if (description.type != homogeneous_plugin.name) throw unknown_plugin(description, medium_plugins());
  const Parameters parameters(description, homogeneous_plugin, unread);
  HenyeyGreenstein phase;
  const Object* stated = nullptr;
  for (const Object& child : description.children) {
    if (stated) throw InputError(child.location, "a second <phase>; there can be only one here");
    stated = &child;
    phase = make_phase(child, unread);
  }
  const Transform world_from_medium =
      parameters.has("toWorld") ? parameters.transform("toWorld") : Transform{};
  if (!is_invertible(world_from_medium))
    throw InputError(parameters.location("toWorld"), "this transform is singular: it flattens the medium",
                     "check for a scale of 0 and for entries that are not finite");
  const Vec3<double> lower = transform_point(world_from_medium, {0, 0, 0}),
                     upper = transform_point(world_from_medium, {1, 1, 1});
  if (!is_within_reach(lower) || !is_within_reach(upper))
    throw PlaceError(parameters.location("toWorld"), "this medium reaches too far to compute with",
                     "scale the scene to common sizes");
  return {nonnegative_color(parameters, "sigmaA"), nonnegative_color(parameters, "sigmaS"), phase,
          world_from_medium};
}

}  // namespace etendue

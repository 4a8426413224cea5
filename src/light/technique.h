// How a light sample finds its place on the light that has been chosen.
#pragma once

#include "base/simd_math.h"

#include <string_view>

namespace etendue {

/// Of polygons (the facets of meshes, and rectangles), disks and spheres, these by solid angle unless
/// projected_solid_angle is asked for; and of light from everywhere, whose directions are uniform by area and
/// solid_angle, else go by the cosine.
///   area: a point uniform on the surface, as course handouts have it.
///   solid_angle: a direction uniform among those in which the receiver sees the light.
///   projected_solid_angle: a direction with density in proportion to the cosine at the receiver; disks, and
///     where light is scattered from both sides, or floats cannot (is_accurate), as solid_angle.
///   automatic: as area where the light is small for its distance (is_small_from), else as solid_angle: of
///     several stratified samples projected_solid_angle leaves no less noise, and takes longer.
///   transformed_cosine: of polygons at glossy receivers also a direction with density in proportion to the
///     lobe (LobePolygon), else as automatic, which does that where the lobe varies over the polygon.
enum class LightTechnique { area, solid_angle, projected_solid_angle, automatic, transformed_cosine };

/// Whether a light is so much longer than wide that its area (m^2) tells nothing of its size: a square of the
/// same diagonal has four times as much. \param longest_sq the square of the longest diagonal (m^2)
template <class F>
auto is_long(const F& area, const F& longest_sq) {
  return F(0.5f) * longest_sq > F(4) * area;
}
/// The area (m^2) of a light, of long ones that of a square of the same diagonal.
template <class F>
F spread_of(const F& area, const F& longest_sq) {
  return select(is_long(area, longest_sq), F(0.5f) * longest_sq, area);
}
/// Whether it hardly matters where on a light of this spread (m^2): from four sides of a square as large on.
template <class F>
auto is_small_from(const F& distance_sq, const F& spread) {
  constexpr float sides = 4;
  return distance_sq > F(sides * sides) * spread;
}

/// area, solid_angle, projected, auto or ltc.
std::string_view light_technique_name(LightTechnique technique);
/// Throws InputError with the known names.
LightTechnique light_technique_from_name(std::string_view name);

}  // namespace etendue

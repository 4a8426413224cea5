// Where a light is and where it shines, for those who choose among many.
#pragma once

#include "geometry/box.h"

#include <span>

namespace etendue {

/// Conservative: all of the light lies in the box, all its normals in the cone, and from a place with the
/// normal n it shines only within the emission angle of n (Conty Estevez and Kulla 2018, "Importance sampling
/// of many lights with adaptive tree splitting", section 4.1).
struct LightBounds {
  Box box;
  Vec3f axis;          ///< Unit; of the cone of normals.
  float cos_normals;   ///< Of the cone's half angle; -1: every direction.
  float cos_emission;  ///< 0 for surfaces, which shine up to a right angle.
};

/// Of flat parts in the box. \param across each of them, with lengths in proportion to their areas
LightBounds bounds_of(const Box& box, std::span<const Vec3<double>> across);

}  // namespace etendue

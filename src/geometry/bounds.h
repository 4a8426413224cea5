// The sphere around all shapes of a scene: what is outside of it hides nothing.
#pragma once

#include "geometry/geometry.h"

namespace etendue {

/// Around the box of all vertices and spheres, so at most 1.74 times as large as need be; radius 0 at the
/// origin where there is no shape.
Sphere bounding_sphere(const Geometry& geometry);

}  // namespace etendue

// Around shapes: boxes of one, and the sphere of all, outside of which nothing hides anything.
#pragma once

#include "geometry/box.h"
#include "geometry/geometry.h"

namespace etendue {

/// Around the box of all vertices, spheres and disks, so at most 1.74 times as large as need be; radius 0 at
/// the origin where there is no shape.
Sphere bounding_sphere(const Geometry& geometry);

Box box_of(const Disk& disk);  ///< Rounded outwards, like the next.
Box box_of(const Sphere& sphere);
Box box_of(const Geometry& geometry, std::int32_t id);  ///< Of one shape; a mesh's exactly.

}  // namespace etendue

// Around shapes: boxes of one, and the sphere of all, outside of which nothing hides anything.
#pragma once

#include "geometry/box.h"
#include "geometry/geometry.h"

#include <array>

namespace etendue {

/// Around the box of all vertices, spheres and disks, so at most 1.74 times as large as need be; radius 0 at
/// the origin where there is no shape.
Sphere bounding_sphere(const Geometry& geometry);

/// Half the size of a disk's bounding box along each axis (m).
std::array<double, 3> half_extent(const Disk& disk);

Box box_of(const Disk& disk);  ///< Rounded outwards, like the next.
Box box_of(const Sphere& sphere);

}  // namespace etendue

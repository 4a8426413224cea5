// Shapes that a scene names without a file.
//
// To add one made of triangles: make its mesh here, and give it its plugin description and its case in
// scene/load_shape.cpp. An exact one, as sphere and disk are, needs a column in geometry.h too, its rays in
// raycast_embree.cpp and, if it may shine, a kind of light (light/light.h).
#pragma once

#include "geometry/geometry.h"
#include "geometry/mesh.h"

namespace etendue {

/// The square [-1, 1]^2 at z = 0, facing +z, uv (0, 0) at (-1, -1) and (1, 1) at (1, 1); then
/// `world_from_object`. Two triangles, flat. A mirroring transform keeps the front side: normals go by the
/// inverse transpose. Two triangles come back whatever the transform; the caller checks that it
/// is_invertible().
Mesh make_rectangle(const Transform& world_from_object);

/// The unit disk at z = 0, facing +z, under `world_from_object`: an ellipse where that scales x and y
/// unlike. A mirroring transform keeps the front side, as above.
Disk make_disk(const Transform& world_from_object);

}  // namespace etendue

// Triangles that a mesh has more than once.
#pragma once

#include "geometry/mesh.h"

#include <cstddef>

namespace etendue {

/// Leaves only the first of triangles with the same corners in the same turn. On a light they matter: light
/// samples would find the radiance of every copy, rays that of one. \return how many are gone
std::size_t remove_repeated_triangles(Mesh& mesh);

}  // namespace etendue

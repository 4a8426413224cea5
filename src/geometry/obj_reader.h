// Wavefront OBJ -> Mesh.
#pragma once

#include <filesystem>

#include "geometry/mesh.h"

namespace etendue {

/// Reads v, vt, vn and f (triangles, quads split (0,1,2),(3,0,2), larger polygons as fans), applies
/// `world_from_object`, renormalises normals. Other statements are skipped. Negative indices count from the end.
/// Throws InputError with the line for: a missing or empty file, no face, a malformed or non-finite number, an
/// index out of range, a face of fewer than three vertices, a normal that the transform or the file makes zero.
Mesh read_obj(const std::filesystem::path& file, const Transform& world_from_object);

}  // namespace etendue

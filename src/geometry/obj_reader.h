// Wavefront OBJ -> Mesh.
#pragma once

#include "geometry/mesh.h"

#include <filesystem>

namespace etendue {

/// Reads v, vt, vn and f (triangles, quads split (0,1,2),(3,0,2), larger polygons as fans) and applies
/// `world_from_object`. Other statements are skipped; what follows x y z in a v must be numbers (weight,
/// colour) and is ignored. Negative indices count back from the last vertex before the face; positive ones
/// may name a vertex that follows later in the file. Vertices appear in the order of their first use; a
/// position used with several uvs or normals becomes several vertices.
///
/// - Normals are transformed by the inverse transpose and renormalised. If no face has any, the mesh has
///   none. If some have, a triangle that lacks one at a corner is flat: its corners get its geometric normal.
/// - Likewise uvs: none, or one for each vertex, (0, 0) where the file gives none.
/// - With vertex normals, a triangle whose winding points against the sum of its three normals gets its
///   winding turned, so that geometric and shading normal agree in side. Without, the winding after the
///   transform says which side is front: a mirroring transform turns such a mesh inside out, as in Nori.
/// - Triangles without area are left out and counted. Without area means: a height of at most 2^-21 of the
///   longest edge, where the normal would be rounding error in float, or an area below 5.4e-20 m^2.
///
/// Throws InputError with the line for: a missing or empty file, no face, no triangle with an area, a
/// malformed or non-finite number, an index out of range, a face of fewer than three vertices, a triangle
/// whose area (above 9e18 m^2) a float cannot hold squared, a normal that the transform or the file makes
/// zero and that a triangle uses.
Mesh read_obj(const std::filesystem::path& file, const Transform& world_from_object);

}  // namespace etendue

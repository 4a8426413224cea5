// Wavefront OBJ -> Mesh.
#pragma once

#include "geometry/mesh.h"

#include <filesystem>

namespace etendue {

/// Reads v, vt, vn and f (triangles, quads, larger polygons) and applies
/// `world_from_object`. Other statements are skipped, and the materials of `usemtl`
/// counted; what follows x y z in a v must be numbers (weight,
/// colour) and is ignored. Negative indices count back from the last vertex before the face; positive ones
/// may name a vertex that follows later in the file; vt and vn of 0 mean that there is none, as Cinema 4D
/// writes them. Normals are transformed by the inverse transpose and renormalised. MeshBuilder has the rules
/// for what the faces become.
///
/// Throws InputError with the line for: a missing or empty file, no face, no triangle with an area, a
/// malformed or non-finite number, an index out of range, a face of fewer than three vertices, a triangle
/// whose area (above 9e18 m^2) a float cannot hold squared, a normal that the transform or the file makes
/// zero and that a triangle uses.
Mesh read_obj(const std::filesystem::path& file, const Transform& world_from_object);

/// The same in two steps, for a file that is used several times, or by its materials. What depends on the
/// transform (normals without direction, triangles too large or without area) is thrown where the mesh is
/// made, and so is a material that no face has.
MeshFile read_obj_file(const std::filesystem::path& file);

}  // namespace etendue

// Polygon File Format (PLY) -> Mesh.
#pragma once

#include "geometry/mesh.h"

#include <filesystem>

namespace etendue {

/// Reads version 1.0 as ASCII or binary of either byte order (Turk 1994, "The PLY Polygon File Format"), with
/// properties of any scalar type in any order, and applies `world_from_object`.
///
/// - Element `vertex`: x y z; nx ny nz; uv as the first pair there is of u v, s t, texture_u texture_v.
/// - Element `face`: the list `vertex_indices` or `vertex_index` of three or more vertices, counted from 0.
/// - Other elements and properties are skipped. In ASCII, each vertex or face is one line.
///
/// Normals are transformed by the inverse transpose and renormalised. MeshBuilder has the rules for what the
/// faces become.
///
/// Throws InputError, with the line where the file is text there and else the number of the vertex or face,
/// for: a missing or empty file, a malformed header, a file that is too short or too long for what its header
/// says, no face, triangle strips, a number that is not finite, an index out of range, a face of fewer than
/// three vertices, no triangle with an area, a triangle whose area (above 9e18 m^2) a float cannot hold
/// squared, a normal that the transform or the file makes zero and that a triangle uses. Memory follows what
/// the file holds, never what it claims.
Mesh read_ply(const std::filesystem::path& file, const Transform& world_from_object);

/// The same in two steps, for a file that is used several times. What depends on the transform is thrown
/// where the mesh is made.
MeshFile read_ply_file(const std::filesystem::path& file);

}  // namespace etendue

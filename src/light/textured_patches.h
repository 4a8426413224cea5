// A mesh as parallelograms and triangles over each of which texture coordinates are one affine map.
#pragma once

#include "base/vec.h"
#include "geometry/geometry.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Places are origin + s edge_s + t edge_t (m), and uv likewise; s and t from 0 to 1, in a triangle s + t
/// <= 1. Seen from the front, edge_s turns to the left into edge_t.
struct TexturedPatch {
  Vec3<double> origin, edge_s, edge_t;
  Vec2<double> uv, uv_s, uv_t;
  bool is_triangle = true;
};

struct TexturedPatches {
  std::vector<TexturedPatch> patches;
  std::vector<std::int32_t> of_triangle;  ///< Of each triangle of the mesh: the number of its patch.
};

/// Two triangles that share a side are one patch where they make a parallelogram in space and in uv, to
/// within 1e-5 of its size. \param geometry_id of a mesh with texture coordinates
TexturedPatches textured_patches(const Geometry& geometry, std::int32_t geometry_id);

}  // namespace etendue

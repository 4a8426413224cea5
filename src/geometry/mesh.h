// A triangle mesh as it lies in memory: positions, optional vertex normals and uvs, indices.
#pragma once

#include "base/transform.h"
#include "base/vec.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Triangles in world space (m). One index addresses position, normal and uv alike.
struct Mesh {
  std::string name;  ///< For messages: the file's path, or what generated it.
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;          ///< Unit, one per position, or empty.
  std::vector<Vec2f> uvs;              ///< One per position, or empty.
  std::vector<std::uint32_t> indices;  ///< Three per triangle.
  std::size_t dropped_triangles = 0;   ///< Left out for having no area; worth a warning.
  std::vector<std::string> warnings;   ///< What is odd about the file; complete messages.
  std::size_t materials = 0;           ///< That its file gives to parts of it.
  std::string materials_passed_over;   ///< The complete message, where there are any.

  std::size_t triangle_count() const { return indices.size() / 3; }
};

/// A file that has been read once: its mesh under any world_from_object. \param usemtl of the faces of one
/// material, by its name, where one is given ("": of those without); else of all
using MeshFile =
    std::function<Mesh(const Transform& world_from_object, const std::optional<std::string>& usemtl)>;

}  // namespace etendue

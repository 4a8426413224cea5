// Faces of a mesh file -> Mesh: the rules that hold whatever the format.
#pragma once

#include "base/error.h"
#include "geometry/mesh.h"
#include "geometry/polygon.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// What one corner of a face names: indices from 0 into MeshParts, or `none` for uv and normal.
struct Corner {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t position, uv = none, normal = none;
  friend bool operator==(const Corner&, const Corner&) = default;
};

/// What a file lists, in the space of the object.
struct ObjectParts {
  std::vector<Vec3<double>> positions, normals;
  std::vector<Vec2f> uvs;
};

/// The same in world space; a normal without direction is zero.
struct MeshParts {
  std::vector<Vec3f> positions;
  std::vector<Vec2f> uvs;
  std::vector<Vec3f> normals;
};

/// Positions that do not fit a float are infinite.
MeshParts in_world(const ObjectParts& parts, const Transform& world_from_object);

/// Gives each distinct corner a vertex of the mesh. Most positions have one uv and one normal, so the first
/// vertex of each position is found by index; only further ones go through a hash table (open addressing,
/// linear probing).
class VertexTable {
 public:
  explicit VertexTable(std::size_t position_count) : first_of_position_(position_count, Corner::none) {}

  /// The corner's vertex: number `size() - 1` where it is new.
  std::uint32_t find_or_add(const Corner& corner);
  std::size_t size() const { return corners_.size(); }

 private:
  std::uint32_t add(const Corner& corner);
  std::size_t find_slot(const Corner& c) const;
  void grow();

  std::vector<Corner> corners_;
  std::vector<std::uint32_t> first_of_position_;
  std::vector<std::uint32_t> slots_;
  std::size_t split_count_ = 0;
};

/// Vertices appear in the order of their first use; a position used with several uvs or normals becomes
/// several vertices.
///
/// - What has more corners than three is cut into triangles as triangulate() says; polygons that cross
///   themselves, or are far from flat, are warned of, with the first of them.
/// - If any corner has a normal, a triangle that lacks one at a corner is flat: its corners get its geometric
///   normal. Likewise uvs: (0, 0) where a corner has none.
/// - With vertex normals, a triangle whose winding points against the sum of its three normals gets its
///   winding turned, so that geometric and shading normal agree in side. Without, the winding after the
///   transform says which side is front: a mirroring transform turns such a mesh inside out, as in Nori.
/// - Triangles without area are left out and counted. Without area means: a height of at most 2^-21 of the
///   longest edge, where the normal would be rounding error in float, or an area below 5.4e-20 m^2.
class MeshBuilder {
 public:
  /// Makes the error of a face, a position or a normal, by its number in the file. The problem of a normal
  /// is what is said of it: "has no direction".
  using ErrorAt =
      std::function<InputError(std::size_t index, std::string_view problem, std::string_view hint)>;
  struct Errors {
    ErrorAt at_face, at_position, at_normal;
  };

  /// Throws for a position of `parts` that does not fit a float. \param name for messages: the file's path
  MeshBuilder(std::string name, const ObjectParts& parts, const Transform& world_from_object, bool has_uvs,
              bool has_normals, Errors errors);

  void reserve_triangles(std::size_t count) { mesh_.indices.reserve(3 * count); }

  /// Three corners or more, each of which exists. Throws for a triangle whose area (above 9e18 m^2) a float
  /// cannot hold squared, for one with a corner out of reach (base/reach.h) and for a normal without
  /// direction that a triangle uses.
  void add_face(std::size_t face, std::span<const Corner> corners);

  /// Throws, at the first face, where no triangle has an area.
  Mesh finish() &&;

 private:
  /// Faces of one fault: the first of them, and how many.
  struct OddFaces {
    std::size_t first, count = 0;
    void add(std::size_t face) {
      if (count++ == 0) first = face;
    }
  };
  void warn(const OddFaces& faces, std::string_view problem, std::string_view problems,
            std::string_view hint);
  void add_triangle(std::size_t face, std::array<Corner, 3> corners);
  void give_normals(std::array<Corner, 3>& corners, const Vec3<double>& double_area_normal);
  void add_vertex(const Corner& corner);

  MeshParts parts_;
  bool has_uvs_, has_normals_;
  Errors errors_;
  VertexTable vertices_;
  PolygonTriangles triangles_;
  std::vector<Vec3<double>> polygon_;
  std::optional<std::size_t> first_face_;
  OddFaces crossing_, bent_;
  Mesh mesh_;
};

}  // namespace etendue

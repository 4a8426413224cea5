// All shapes of a scene in shared tables, addressed by the ids that ray casting returns.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "base/vec.h"
#include "geometry/mesh.h"

#include <cstdint>
#include <vector>

namespace etendue {

struct Sphere {
  Vec3f center;  ///< World, m.
  float radius;  ///< m, > 0.
};

/// The unit disk under an affine transform: a disk or an ellipse.
struct Disk {
  Vec3f center;            ///< World, m.
  Vec3f along_x, along_y;  ///< From the centre to the edge, where the unit disk's x and y axes end (m).
  Vec3f ng;                ///< Unit, on the front side.
};

/// What a surface is made of and whether it shines, by id; -1: none.
struct SurfaceIds {
  std::int32_t material;
  std::int32_t light = -1;
};

/// Every mesh's vertices and triangles one behind the other, so that a packet whose lanes hit different
/// meshes still gathers from one array. A geometry is one mesh, one sphere or one disk.
class Geometry {
 public:
  /// Each returns the geometry's id.
  std::int32_t add_mesh(const Mesh& mesh, SurfaceIds ids);
  std::int32_t add_sphere(const Sphere& added, SurfaceIds ids, float u_offset_of_sphere = 0);
  std::int32_t add_disk(const Disk& added, SurfaceIds ids);

  std::int32_t count() const { return std::int32_t(material.size()); }
  std::size_t triangle_count() const { return indices.size() / 3; }

  // Per geometry.
  std::vector<std::int32_t> material, light;
  std::vector<std::int32_t> first_triangle;  ///< Into `indices`, in triangles; 0 unless a mesh.
  std::vector<std::int32_t> has_normals;     ///< 1 where the mesh has vertex normals.
  std::vector<std::int32_t> has_uvs;         ///< 1 where the mesh has texture coordinates.
  std::vector<std::int32_t> triangles;       ///< Number of them; 0 unless a mesh.
  std::vector<std::int32_t> sphere;          ///< Into `spheres`; -1 unless a sphere.
  std::vector<std::int32_t> disk;            ///< Into `disks`; -1 unless a disk.
  std::vector<float> longest_edge;           ///< Of a mesh's triangles (m); 0 unless a mesh.
  std::vector<float> u_offset;               ///< Of a sphere: what is added to its u, in [0, 1).
  // Per vertex, of all meshes. Normals are packed like the positions, zero where a mesh has none. The ray
  // caster reads 16 bytes of each position, so one spare vertex always stands behind the last.
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  // Three global vertex numbers a triangle.
  std::vector<std::int32_t> indices;
  std::vector<Sphere> spheres;
  std::vector<Disk> disks;
  bool has_any_normals = false;

 private:
  /// Of no shape yet.
  void add_row(SurfaceIds ids);
};

/// The vertex normal interpolated at barycentric (u, v), not normalised; lanes must be in `m`.
template <class F>
Vec3<F> interpolate_normal(const Geometry& geometry, const Int<F>& geometry_id, const Int<F>& primitive,
                           const Vec2<F>& barycentric, const Mask<F>& m) {
  const Int<F> zero(0);
  const Int<F> triangle =
      select(m, gather(geometry.first_triangle.data(), select(m, geometry_id, zero)) + primitive, zero);
  const std::int32_t* indices = geometry.indices.data();
  const float* normals = &geometry.normals[0].x;
  const auto normal = [&](int corner) {
    const Int<F> at = gather(indices + corner, triangle * Int<F>(3)) * Int<F>(3);
    return gather_vec3<F>(normals, at);
  };
  const F w = F(1) - barycentric.x - barycentric.y;
  return normal(0) * w + normal(1) * barycentric.x + normal(2) * barycentric.y;
}

}  // namespace etendue

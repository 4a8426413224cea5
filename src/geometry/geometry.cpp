#include "geometry/geometry.h"

#include "base/error.h"

#include <limits>

namespace etendue {

std::int32_t Geometry::add_mesh(const Mesh& mesh, SurfaceIds ids) {
  // A gather's index is 3 * vertex or 3 * triangle + corner in 32 bits.
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() / 3;
  if (positions.size() + mesh.positions.size() > most || indices.size() + mesh.indices.size() > most)
    throw InputError("the scene has more than 715 million vertices or 238 million triangles");
  if (!positions.empty()) positions.pop_back();  // The spare vertex moves to the new end.
  const auto first_vertex = std::int32_t(positions.size());
  add_row(ids);
  first_triangle.back() = std::int32_t(indices.size() / 3);
  has_normals.back() = mesh.normals.empty() ? 0 : 1;
  has_uvs.back() = mesh.uvs.empty() ? 0 : 1;
  triangles.back() = std::int32_t(mesh.triangle_count());
  has_any_normals = has_any_normals || !mesh.normals.empty();
  positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
  if (mesh.normals.empty())
    normals.resize(positions.size(), Vec3f{0, 0, 0});
  else
    normals.insert(normals.end(), mesh.normals.begin(), mesh.normals.end());
  if (mesh.uvs.empty())
    uvs.resize(positions.size(), Vec2f{0, 0});
  else
    uvs.insert(uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
  positions.push_back(Vec3f{0, 0, 0});
  indices.reserve(indices.size() + mesh.indices.size());
  for (const std::uint32_t index : mesh.indices) indices.push_back(first_vertex + std::int32_t(index));
  return count() - 1;
}

std::int32_t Geometry::add_sphere(const Sphere& added, SurfaceIds ids) {
  add_row(ids);
  sphere.back() = std::int32_t(spheres.size());
  spheres.push_back(added);
  return count() - 1;
}

std::int32_t Geometry::add_disk(const Disk& added, SurfaceIds ids) {
  add_row(ids);
  disk.back() = std::int32_t(disks.size());
  disks.push_back(added);
  return count() - 1;
}

void Geometry::add_row(SurfaceIds ids) {
  material.push_back(ids.material);
  light.push_back(ids.light);
  for (std::vector<std::int32_t>* column : {&first_triangle, &has_normals, &has_uvs, &triangles})
    column->push_back(0);
  for (std::vector<std::int32_t>* column : {&sphere, &disk}) column->push_back(-1);
}

}  // namespace etendue

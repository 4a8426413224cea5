#include "geometry/geometry.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace etendue {

std::int32_t Geometry::add_mesh(const Mesh& mesh, SurfaceIds ids) {
  // A gather's index is 3 * vertex or 3 * triangle + corner in 32 bits.
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() / 3;
  if (positions.size() + mesh.positions.size() > most || indices.size() + mesh.indices.size() > most)
    throw InputError("the scene has more than 715 million vertices or 238 million triangles");
  // No reserve to the size needed: it would copy all tables for each mesh.
  const std::size_t first_vertex = positions.empty() ? 0 : positions.size() - 1;
  const std::size_t end = first_vertex + mesh.positions.size(), first_index = indices.size();
  add_row(ids);
  first_triangle.back() = std::int32_t(first_index / 3);
  has_normals.back() = mesh.normals.empty() ? 0 : 1;
  has_uvs.back() = mesh.uvs.empty() ? 0 : 1;
  triangles.back() = std::int32_t(mesh.triangle_count());
  has_any_normals = has_any_normals || !mesh.normals.empty();
  positions.resize(end + 1);  // And the spare vertex.
  normals.resize(end, Vec3f{0, 0, 0});
  uvs.resize(end, Vec2f{0, 0});
  const auto at_first = [&](auto& column) { return column.begin() + std::ptrdiff_t(first_vertex); };
  std::copy(mesh.positions.begin(), mesh.positions.end(), at_first(positions));
  std::copy(mesh.normals.begin(), mesh.normals.end(), at_first(normals));
  std::copy(mesh.uvs.begin(), mesh.uvs.end(), at_first(uvs));
  positions.back() = {0, 0, 0};
  indices.resize(first_index + mesh.indices.size());
  std::transform(mesh.indices.begin(), mesh.indices.end(), indices.begin() + std::ptrdiff_t(first_index),
                 [&](std::uint32_t index) { return std::int32_t(first_vertex + index); });
  float longest_sq = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}})
      longest_sq = std::max(longest_sq, length_sq(mesh.positions[mesh.indices[i + std::size_t(a)]] -
                                                  mesh.positions[mesh.indices[i + std::size_t(b)]]));
  longest_edge.back() = std::sqrt(longest_sq);
  return count() - 1;
}

std::int32_t Geometry::add_sphere(const Sphere& added, SurfaceIds ids, float u_offset_of_sphere) {
  add_row(ids);
  u_offset.back() = u_offset_of_sphere;
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
  u_offset.push_back(0);
  for (std::vector<std::int32_t>* column : {&first_triangle, &has_normals, &has_uvs, &triangles})
    column->push_back(0);
  for (std::vector<std::int32_t>* column : {&sphere, &disk}) column->push_back(-1);
  longest_edge.push_back(0);
}

}  // namespace etendue

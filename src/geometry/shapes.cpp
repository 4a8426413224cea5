#include "geometry/shapes.h"

namespace etendue {

Mesh make_rectangle(const Transform& world_from_object) {
  Mesh mesh;
  mesh.name = "rectangle";
  for (const auto& uv : {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{1, 1}, Vec2f{0, 1}}) {
    const auto p = transform_point(world_from_object, {2.0 * uv.x - 1, 2.0 * uv.y - 1, 0});
    mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    mesh.uvs.push_back(uv);
  }
  if (determinant(world_from_object) < 0)
    mesh.indices = {0, 2, 1, 0, 3, 2};
  else
    mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Disk make_disk(const Transform& world_from_object) {
  const auto along_x = transform_vector(world_from_object, {1, 0, 0}),
             along_y = transform_vector(world_from_object, {0, 1, 0});
  const auto normal = normalize(cross(along_x, along_y));
  return {narrow(transform_point(world_from_object, {0, 0, 0})), narrow(along_x), narrow(along_y),
          narrow(determinant(world_from_object) < 0 ? -normal : normal)};
}

}  // namespace etendue

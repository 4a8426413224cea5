#include "light/mesh_light.h"

#include "base/alias_table.h"

namespace etendue {

std::int32_t MeshLights::add(const Geometry& geometry, std::int32_t geometry_id) {
  const auto first = std::size_t(geometry.first_triangle[std::size_t(geometry_id)]);
  const auto count = std::size_t(geometry.triangles[std::size_t(geometry_id)]);
  geometry_id_.push_back(geometry_id);
  first_triangle_.push_back(std::int32_t(alias_.size()));
  triangle_count_.push_back(std::int32_t(count));
  pieces_per_triangle_.push_back(float(light_pieces) / float(count));
  std::vector<double> areas;
  areas.reserve(count);
  double total_area = 0;
  for (std::size_t t = first; t < first + count; ++t) {
    const auto corner = [&](int k) { return geometry.positions[std::size_t(geometry.indices[3 * t + k])]; };
    const Vec3f origin = corner(0), edge_1 = corner(1) - origin, edge_2 = corner(2) - origin;
    for (const Vec3f& v : {origin, edge_1, edge_2}) triangles_.insert(triangles_.end(), {v.x, v.y, v.z});
    const auto wide = [](const Vec3f& v) { return Vec3<double>{v.x, v.y, v.z}; };
    areas.push_back(0.5 * length(cross(wide(edge_1), wide(edge_2))));
    total_area += areas.back();
  }
  const AliasTable table = make_alias_table(areas);
  alias_threshold_.insert(alias_threshold_.end(), table.threshold.begin(), table.threshold.end());
  alias_.insert(alias_.end(), table.alias.begin(), table.alias.end());
  pdf_area_.push_back(float(1 / total_area));
  return std::int32_t(pdf_area_.size()) - 1;
}

}  // namespace etendue

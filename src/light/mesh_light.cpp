#include "light/mesh_light.h"

#include "base/alias_table.h"
#include "light/light_pieces.h"

namespace etendue {

namespace {

/// Whether the box around a triangle has a volume.
bool has_thick_box(const Vec3f& edge_1, const Vec3f& edge_2) {
  return (edge_1.x != 0 || edge_2.x != 0) && (edge_1.y != 0 || edge_2.y != 0) &&
         (edge_1.z != 0 || edge_2.z != 0);
}

}  // namespace

LightBounds MeshLights::facet_bounds(std::int32_t row, std::int32_t facet) const {
  const std::int32_t polygon = first_facet_[row] + facet;
  return {polygons_.box(polygon), polygons_.ng(polygon), 1 - 1e-6f, 0};
}

void MeshLights::add_facets(const Geometry& geometry, std::int32_t geometry_id) {
  const auto first = std::size_t(geometry.first_triangle[std::size_t(geometry_id)]);
  const auto count = std::size_t(geometry.triangles[std::size_t(geometry_id)]);
  const ConvexPieces facets =
      convex_pieces(geometry.positions, std::span(geometry.indices).subspan(3 * first, 3 * count));
  first_facet_.push_back(polygons_.count());
  facet_count_.push_back(facets.count());
  facet_of_triangle_.insert(facet_of_triangle_.end(), facets.piece.begin(), facets.piece.end());
  std::vector<double> areas;
  std::vector<Vec3f> centers;
  for (std::int32_t k = 0; k < facets.count(); ++k) {
    const auto begin = std::size_t(facets.first_corner[std::size_t(k)]),
               end = std::size_t(facets.first_corner[std::size_t(k) + 1]);
    const std::int32_t polygon = polygons_.add(std::span(facets.corners).subspan(begin, end - begin));
    areas.push_back(polygons_.area(polygon));
    const Box box = polygons_.box(polygon);
    centers.push_back((box.low + box.high) * 0.5f);
  }
  const std::vector<std::int32_t> pieces = pieces_of(centers);
  for (std::int32_t k = 0; k < facets.count(); ++k)
    polygons_.set_label(polygons_.count() - facets.count() + k, pieces[std::size_t(k)]);
  const AliasTable table = make_alias_table(areas);
  facet_threshold_.insert(facet_threshold_.end(), table.threshold.begin(), table.threshold.end());
  facet_alias_.insert(facet_alias_.end(), table.alias.begin(), table.alias.end());
}

std::int32_t MeshLights::add(const Geometry& geometry, std::int32_t geometry_id) {
  const auto first = std::size_t(geometry.first_triangle[std::size_t(geometry_id)]);
  const auto count = std::size_t(geometry.triangles[std::size_t(geometry_id)]);
  first_triangle_.push_back(std::int32_t(alias_.size()));
  triangle_count_.push_back(std::int32_t(count));
  std::vector<double> areas;
  std::vector<Vec3<double>> across;
  Box box;
  std::size_t thick_boxes = 0;
  std::vector<Vec3f> centers;
  double total_area = 0;
  for (std::size_t t = first; t < first + count; ++t) {
    const auto corner = [&](int k) { return geometry.positions[std::size_t(geometry.indices[3 * t + k])]; };
    const Vec3f origin = corner(0), edge_1 = corner(1) - origin, edge_2 = corner(2) - origin;
    for (const Vec3f& v : {origin, edge_1, edge_2}) triangles_.insert(triangles_.end(), {v.x, v.y, v.z});
    thick_boxes += has_thick_box(edge_1, edge_2);
    centers.push_back(origin + (edge_1 + edge_2) * (1.0f / 3));
    across.push_back(cross(widen(edge_1), widen(edge_2)));
    for (const int k : {0, 1, 2}) box.include(corner(k));
    areas.push_back(0.5 * length(across.back()));
    total_area += areas.back();
  }
  constexpr std::size_t few_a_piece = 2;
  finely_built_count_ += thick_boxes > few_a_piece * light_pieces;
  const std::vector<std::int32_t> pieces = pieces_of(centers);
  pieces_.insert(pieces_.end(), pieces.begin(), pieces.end());
  const AliasTable table = make_alias_table(areas);
  alias_threshold_.insert(alias_threshold_.end(), table.threshold.begin(), table.threshold.end());
  alias_.insert(alias_.end(), table.alias.begin(), table.alias.end());
  pdf_area_.push_back(float(1 / total_area));
  longest_edge_.push_back(geometry.longest_edge[std::size_t(geometry_id)]);
  bounds_.push_back(bounds_of(box, across));
  add_facets(geometry, geometry_id);
  return pdf_area_.size() - 1;
}

}  // namespace etendue

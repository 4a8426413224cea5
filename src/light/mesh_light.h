// Area lights on triangle meshes of any size: as the handouts do it, a triangle by area, then a point uniform
// within it; or one of the convex polygons that flat parts of the mesh are cut into, by any technique.
#pragma once

#include "base/alias_table.h"
#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/geometry.h"
#include "light/glossy_polygon_light.h"
#include "light/light_table.h"

#include <cstdint>
#include <vector>

namespace etendue {

class MeshLights {
 public:
  /// Makes the mesh `geometry_id` a light; returns its row. Its total area must be positive.
  std::int32_t add(const Geometry& geometry, std::int32_t geometry_id);

  std::int32_t count() const { return pdf_area_.size(); }

  /// Lights on which a packet of shadow rays meets many triangles although it aims at one piece: rays end
  /// just short of their light, but within the boxes around its triangles, unless these lie flat in a plane
  /// of two axes.
  std::int32_t finely_built_count() const { return finely_built_count_; }

  static constexpr LightPlace place = LightPlace::surface;

  template <class F>
  LightSample<F> sample(LightRequest<F> request) const {
    const Mask<F> is_whole = less(request.facet, Int<F>(0));
    if (request.technique == LightTechnique::area && all(is_whole))
      return light_sample_at(sample_position<F>(request.row, request.u), request);
    const Int<F> first = first_facet_.at(request.row);
    if (any(is_whole)) {
      const AliasSample<F> facet = sample_alias<F>(facet_threshold_.data(), facet_alias_.data(), first,
                                                   facet_count_.at(request.row), request.u.y);
      request.facet = select(is_whole, facet.index, request.facet);
      const UInt<F> left = as_uint(to_int(facet.u_left * F(0x1p24f))) << 8;
      request.u.y = as_uint(select(is_whole, as_int(left), as_int(request.u.y)));
      request.pmf =
          select(is_whole, request.pmf * share_of<F>(request.row, first + request.facet), request.pmf);
    }
    const Int<F> polygon = first + request.facet;
    const GlossyPolygonLight<F> light(polygons_, polygon, request.receiver, request.is_twosided,
                                      request.technique, request.lanes);
    const Int<F> pieces = light.label();
    const Int<F> piece = (pieces & Int<F>(0xff)) + to_int(to_unit_float(request.u.x) * to_float(pieces >> 8));
    return light.sample(request, longest_edge_.at(request.row), piece);
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    if (hit.technique == LightTechnique::area && !hit.is_facet_chosen)
      return pdf_solid_angle_at(hit, receiver, pmf * pdf_area_.at(row));
    const Int<F> polygon = first_facet_.at(row) + hit.facet;
    const Mask<F> every_lane = F(0) < F(1);
    const F pdf = GlossyPolygonLight<F>(polygons_, polygon, receiver, every_lane, hit.technique, every_lane)
                      .pdf_solid_angle(hit);
    return pdf * (hit.is_facet_chosen ? pmf : pmf * share_of<F>(row, polygon));
  }

  // Facets are convex polygons that flat parts of the mesh make.
  std::int32_t facet_count(std::int32_t row) const { return facet_count_[row]; }
  double facet_power_share(std::int32_t row, std::int32_t facet) const {
    return polygons_.area(first_facet_[row] + facet) * pdf_area_[row];
  }
  LightBounds facet_bounds(std::int32_t row, std::int32_t facet) const;
  template <class F>
  Int<F> facet_at(const Int<F>& row, const Int<F>& primitive, const Vec3<F>& /*position*/) const {
    return gather(facet_of_triangle_.data(), first_triangle_.at(row) + primitive);
  }

  double power(std::int32_t row, const Sphere& /*scene_bounds*/) const { return pi / pdf_area_[row]; }
  std::optional<LightBounds> bounds(std::int32_t row) const { return bounds_[std::size_t(row)]; }

  /// A point uniform by area. The triangle comes from u.y through an alias table (O(1)); what is left of u.y
  /// is stretched back over [0, 1).
  template <class F>
  LightPoint<F> sample_position(const Int<F>& row, const Vec2<UInt<F>>& u) const {
    using I = Int<F>;
    const I first = first_triangle_.at(row);
    const AliasSample<F> triangle =
        sample_alias<F>(alias_threshold_.data(), alias_.data(), first, triangle_count_.at(row), u.y);
    const Vec2<F> u_triangle{to_unit_float(u.x), triangle.u_left};

    const float* corner = triangles_.data();
    const I at = (first + triangle.index) * I(9);
    const Vec3<F> origin = gather_vec3<F>(corner, at), edge_1 = gather_vec3<F>(corner + 3, at),
                  edge_2 = gather_vec3<F>(corner + 6, at);
    const Vec2<F> barycentric = square_to_triangle(u_triangle);

    LightPoint<F> point;
    const Vec3<F> along_1 = edge_1 * barycentric.x, along_2 = edge_2 * barycentric.y;
    point.position = origin + along_1 + along_2;
    point.ng = normalize(cross(edge_1, edge_2));
    point.clearance = clearance<F>(point.ng, abs_each(origin) + abs_each(along_1) + abs_each(along_2),
                                   longest_edge_.at(row));
    point.pdf_area = pdf_area_.at(row);
    const I pieces = gather(pieces_.data(), first + triangle.index);
    point.piece = (pieces & I(0xff)) + to_int(u_triangle.y * to_float(pieces >> 8));
    return point;
  }

 private:
  /// Of the light's area.
  template <class F>
  F share_of(const Int<F>& row, const Int<F>& polygon) const {
    return polygons_.area_at<F>(polygon) * pdf_area_.at(row);
  }
  void add_facets(const Geometry& geometry, std::int32_t geometry_id);

  // Per light.
  LookupTable<std::int32_t> first_triangle_, triangle_count_;
  LookupTable<float> pdf_area_;      ///< 1 / total area.
  LookupTable<float> longest_edge_;  ///< m
  std::vector<LightBounds> bounds_;
  std::int32_t finely_built_count_ = 0;
  // Per facet of all lights: its polygon, labelled with pieces as of triangles, and the alias table.
  LookupTable<std::int32_t> first_facet_, facet_count_;  ///< Per light.
  PolygonTable polygons_;
  std::vector<std::uint32_t> facet_threshold_;
  std::vector<std::int32_t> facet_alias_;
  std::vector<std::int32_t> facet_of_triangle_;  ///< Of all lights: its number in its light.
  // Per triangle of all lights: the alias table, a corner and two edges, and the triangle's pieces: the first
  // in the low byte, their number above.
  std::vector<std::int32_t> pieces_;
  std::vector<std::uint32_t> alias_threshold_;
  std::vector<std::int32_t> alias_;
  std::vector<float> triangles_;
};

}  // namespace etendue

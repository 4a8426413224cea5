// Area lights on triangle meshes of any size: a triangle by area, then a point uniform within it.
#pragma once

#include "base/alias_table.h"
#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/geometry.h"
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
  LightSample<F> sample(const LightRequest<F>& request) const {
    const Mask<F> is_whole = less(request.facet, Int<F>(0));
    if (all(is_whole)) return light_sample_at(sample_position<F>(request.row, request.u), request);
    const LightPoint<F> point = sample_facet<F>(request.row, select(is_whole, Int<F>(0), request.facet),
                                                {to_unit_float(request.u.x), to_unit_float(request.u.y)});
    if (!any(is_whole)) return light_sample_at(point, request);
    return select(is_whole, light_sample_at(sample_position<F>(request.row, request.u), request),
                  light_sample_at(point, request));
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    const Mask<F> is_whole = less(hit.facet, Int<F>(0));
    F pdf_area = pdf_area_.at(row);
    if (!all(is_whole)) {
      const Int<F> at = (first_triangle_.at(row) + select(is_whole, Int<F>(0), hit.facet)) * Int<F>(9);
      const Vec3<F> across =
          cross(gather_vec3<F>(triangles_.data() + 3, at), gather_vec3<F>(triangles_.data() + 6, at));
      pdf_area = select(is_whole, pdf_area, F(2) / length(across));
    }
    return pdf_solid_angle_at(hit, receiver, pmf * pdf_area);
  }

  std::int32_t facet_count(std::int32_t row) const { return triangle_count_[row]; }
  double facet_area_share(std::int32_t row, std::int32_t facet) const;
  LightBounds facet_bounds(std::int32_t row, std::int32_t facet) const;
  template <class F>
  Int<F> facet_at(const Int<F>& /*row*/, const Int<F>& primitive) const {
    return primitive;
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

    LightPoint<F> point = sample_triangle<F>(row, first + triangle.index, u_triangle);
    point.pdf_area = pdf_area_.at(row);
    const I pieces = gather(pieces_.data(), first + triangle.index);
    point.piece = (pieces & I(0xff)) + to_int(u_triangle.y * to_float(pieces >> 8));
    return point;
  }

 private:
  /// A point uniform on one triangle of the light.
  template <class F>
  LightPoint<F> sample_facet(const Int<F>& row, const Int<F>& facet, const Vec2<F>& u) const {
    return sample_triangle<F>(row, first_triangle_.at(row) + facet, u);
  }

  /// \param triangle among those of all lights
  template <class F>
  LightPoint<F> sample_triangle(const Int<F>& row, const Int<F>& triangle, const Vec2<F>& u) const {
    const float* corner = triangles_.data();
    const Int<F> at = triangle * Int<F>(9);
    const Vec3<F> origin = gather_vec3<F>(corner, at), edge_1 = gather_vec3<F>(corner + 3, at),
                  edge_2 = gather_vec3<F>(corner + 6, at);
    const Vec2<F> barycentric = square_to_triangle(u);

    LightPoint<F> point;
    const Vec3<F> along_1 = edge_1 * barycentric.x, along_2 = edge_2 * barycentric.y;
    point.position = origin + along_1 + along_2;
    const Vec3<F> across = cross(edge_1, edge_2);
    const F twice_area = length(across);
    point.ng = across * (F(1) / twice_area);
    point.pdf_area = F(2) / twice_area;
    point.clearance = clearance<F>(point.ng, abs_each(origin) + abs_each(along_1) + abs_each(along_2),
                                   longest_edge_.at(row));
    point.piece = gather(pieces_.data(), triangle) & Int<F>(0xff);
    return point;
  }

  /// Twice the facet's area, along its normal.
  Vec3<double> across(std::int32_t row, std::int32_t facet) const;

  // Per light.
  LookupTable<std::int32_t> first_triangle_, triangle_count_;
  LookupTable<float> pdf_area_;      ///< 1 / total area.
  LookupTable<float> longest_edge_;  ///< m
  std::vector<LightBounds> bounds_;
  std::int32_t finely_built_count_ = 0;
  // Per triangle of all lights: the alias table, a corner and two edges, and the triangle's pieces: the first
  // in the low byte, their number above.
  std::vector<std::int32_t> pieces_;
  std::vector<std::uint32_t> alias_threshold_;
  std::vector<std::int32_t> alias_;
  std::vector<float> triangles_;
};

}  // namespace etendue

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
    return light_sample_at(sample_position<F>(request.row, request.u), request);
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    return pdf_solid_angle_at(hit, receiver, pmf * pdf_area_.at(row));
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

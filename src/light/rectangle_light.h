// Rectangular (and parallelogram) area lights: a point uniform over the whole, or as a polygon by any
// technique.
#pragma once

#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/geometry.h"
#include "light/glossy_polygon_light.h"
#include "light/light_table.h"

#include <array>
#include <cstdint>
#include <vector>

namespace etendue {

class RectangleLights {
 public:
  /// Spanned by two edges from a corner; shines along their cross product. Returns the row.
  std::int32_t add(const Vec3f& corner, const Vec3f& edge_u, const Vec3f& edge_v) {
    const Vec3f across = cross(edge_u, edge_v);
    const Vec3f ng = normalize(across);
    for (const Vec3f& v : {corner, edge_u, edge_v, ng}) fields_.insert(fields_.end(), {v.x, v.y, v.z});
    pdf_area_.push_back(1 / length(across));
    diagonal_.push_back(length(edge_u) + length(edge_v));
    const std::array corners{corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v};
    polygons_.add(corners);
    return pdf_area_.size() - 1;
  }

  static constexpr LightPlace place = LightPlace::surface;

  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    if (request.technique == LightTechnique::area)
      return light_sample_at(sample_position<F>(request.row, request.u), request);
    const Int<F> piece =
        to_int(to_unit_float(request.u.x) * F(4)) * Int<F>(4) + to_int(to_unit_float(request.u.y) * F(4));
    return GlossyPolygonLight<F>(polygons_, request.row, request.receiver, request.is_twosided,
                                 request.technique, request.lanes)
        .sample(request, diagonal_.at(request.row), piece);
  }

  template <class F>
  F pdf_solid_angle(const Int<F>& row, const F& pmf, const Receiver<F>& receiver,
                    const LightHit<F>& hit) const {
    if (hit.technique == LightTechnique::area)
      return pdf_solid_angle_at(hit, receiver, pmf * pdf_area_.at(row));
    const Mask<F> every_lane = F(0) < F(1);
    return pmf * GlossyPolygonLight<F>(polygons_, row, receiver, every_lane, hit.technique, every_lane)
                     .pdf_solid_angle(hit);
  }

  double power(std::int32_t row, const Sphere& /*scene_bounds*/) const { return pi / pdf_area_[row]; }
  std::optional<LightBounds> bounds(std::int32_t row) const {
    const float* field = fields_.data() + 12 * std::size_t(row);
    const auto vec = [&](int column) { return Vec3f{field[column], field[column + 1], field[column + 2]}; };
    Box box;
    for (const Vec3f& corner : {vec(0), vec(0) + vec(3), vec(0) + vec(6), vec(0) + vec(3) + vec(6)})
      box.include(corner);
    return LightBounds{box, vec(9), 1, 0};
  }

  template <class F>
  LightPoint<F> sample_position(const Int<F>& row, const Vec2<UInt<F>>& u) const {
    const Int<F> at = row * Int<F>(12);
    const auto vec = [&](int column) { return gather_vec3<F>(fields_.data() + column, at); };
    const F x = to_unit_float(u.x), y = to_unit_float(u.y);
    const Vec3<F> ng = vec(9);
    const Int<F> piece = to_int(x * F(4)) * Int<F>(4) + to_int(y * F(4));
    const Vec3<F> corner = vec(0), edge_u = vec(3), edge_v = vec(6);
    const F clear =
        clearance<F>(ng, abs_each(corner) + abs_each(edge_u) + abs_each(edge_v), diagonal_.at(row));
    return {corner + edge_u * x + edge_v * y, ng, pdf_area_.at(row), clear, piece};
  }

 private:
  std::vector<float> fields_;  ///< Corner, two edges, normal: 12 a row.
  LookupTable<float> pdf_area_;
  PolygonTable polygons_;
  LookupTable<float> diagonal_;  ///< At least as long as the longest edge of its triangles (m).
};

}  // namespace etendue

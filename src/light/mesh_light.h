// Area lights on triangle meshes of any size: a triangle by area, then a point uniform within it.
#pragma once

#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/geometry.h"
#include "light/light_point.h"

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

  /// The triangle comes from u.y through an alias table (O(1)); what is left of u.y is stretched back over
  /// [0, 1).
  template <class F>
  LightPoint<F> sample_position(const Int<F>& row, const Vec3<F>& /*reference*/,
                                const Vec2<UInt<F>>& u) const {
    using I = Int<F>;
    const I first = first_triangle_.at(row), count = triangle_count_.at(row);
    const I bucket = as_int(mul_hi(u.y, as_uint(count)));
    const UInt<F> fraction = u.y * as_uint(count);
    const UInt<F> threshold = gather(alias_threshold_.data(), first + bucket);
    const auto is_own = less(fraction, threshold);
    const I triangle = select(is_own, bucket, gather(alias_.data(), first + bucket));
    const F left = to_unit_float(fraction), split = to_unit_float(threshold);
    const F stretched =
        select(is_own, left, left - split) / max(select(is_own, split, F(1) - split), F(0x1p-24f));
    const Vec2<F> u_triangle{to_unit_float(u.x), min(max(stretched, F(0)), F(0x1.fffffep-1f))};

    const float* corner = triangles_.data();
    const I at = (first + triangle) * I(9);
    const Vec3<F> origin = gather_vec3<F>(corner, at), edge_1 = gather_vec3<F>(corner + 3, at),
                  edge_2 = gather_vec3<F>(corner + 6, at);
    const Vec2<F> barycentric = square_to_triangle(u_triangle);

    LightPoint<F> point;
    point.position = origin + edge_1 * barycentric.x + edge_2 * barycentric.y;
    point.ng = normalize(cross(edge_1, edge_2));
    point.pdf_area = pdf_area_.at(row);
    const I pieces = gather(pieces_.data(), first + triangle);
    point.piece = (pieces & I(0xff)) + to_int(u_triangle.y * to_float(pieces >> 8));
    return point;
  }

  /// 1 / total area
  template <class F>
  F pdf_area(const Int<F>& row, const Vec3<F>& /*reference*/, const Vec3<F>& /*position*/,
             const Vec3<F>& /*ng*/) const {
    return pdf_area_.at(row);
  }

 private:
  // Per light.
  LookupTable<std::int32_t> first_triangle_, triangle_count_;
  LookupTable<float> pdf_area_;
  std::int32_t finely_built_count_ = 0;
  // Per triangle of all lights: the alias table, a corner and two edges, and the triangle's pieces: the first
  // in the low byte, their number above.
  std::vector<std::int32_t> pieces_;
  std::vector<std::uint32_t> alias_threshold_;
  std::vector<std::int32_t> alias_;
  std::vector<float> triangles_;
};

}  // namespace etendue

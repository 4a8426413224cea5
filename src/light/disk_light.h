// Disk-shaped (and elliptic) area lights: a point uniform over the whole.
#pragma once

#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "base/simd_math.h"
#include "base/warp.h"
#include "geometry/bounds.h"
#include "light/light_table.h"

#include <cstdint>
#include <vector>

namespace etendue {

class DiskLights {
 public:
  /// Returns the row. The disk's area must be positive and finite.
  std::int32_t add(const Disk& disk) {
    for (const Vec3f& v : {disk.center, disk.along_x, disk.along_y, disk.ng})
      fields_.insert(fields_.end(), {v.x, v.y, v.z});
    pdf_area_.push_back(inv_pi / length(cross(disk.along_x, disk.along_y)));
    return pdf_area_.size() - 1;
  }

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
  std::optional<LightBounds> bounds(std::int32_t row) const {
    const float* field = fields_.data() + 12 * std::size_t(row);
    const auto vec = [&](int column) { return Vec3f{field[column], field[column + 1], field[column + 2]}; };
    const Disk disk{vec(0), vec(3), vec(6), vec(9)};
    return LightBounds{box_of(disk), disk.ng, 1, 0};
  }

  template <class F>
  LightPoint<F> sample_position(const Int<F>& row, const Vec2<UInt<F>>& u) const {
    const Int<F> at = row * Int<F>(12);
    const auto vec = [&](int column) { return gather_vec3<F>(fields_.data() + column, at); };
    const Vec2<F> u_disk{to_unit_float(u.x), to_unit_float(u.y)};
    // An affine map keeps a uniform density uniform.
    const Vec2<F> on_disk = square_to_uniform_disk(u_disk);
    const Vec3<F> ng = vec(9);
    const Int<F> piece = to_int(u_disk.x * F(4)) * Int<F>(4) + to_int(u_disk.y * F(4));
    const Vec3<F> center = vec(0), along_x = vec(3), along_y = vec(6);
    const F clear = clearance<F>(ng, abs_each(center) + abs_each(along_x) + abs_each(along_y), F(0));
    return {center + along_x * on_disk.x + along_y * on_disk.y, ng, pdf_area_.at(row), clear, piece};
  }

 private:
  std::vector<float> fields_;  ///< Centre, the two axes, normal: 12 a row.
  LookupTable<float> pdf_area_;
};

}  // namespace etendue

// Rays against a Geometry, in packets of any width.
#pragma once

#include "geometry/raycast.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue::test {

struct Hits {
  std::vector<float> t, ng_x, ng_y, ng_z, u, v;
  std::vector<std::int32_t> geometry, primitive, is_visible;
};

/// Rays given by origin and direction, a multiple of `width` in number; also whether the segments up to t = 1
/// are free. \param is_active as in RaySpan; empty: all are
inline Hits cast_rays(const RayCaster& caster, const std::vector<Vec3f>& origin,
                      const std::vector<Vec3f>& direction, int width,
                      std::vector<std::int32_t> is_active = {}) {
  const std::size_t n = origin.size();
  if (is_active.empty()) is_active.assign(n, -1);
  std::vector<float> o[3], d[3], t_near(n, 0), t_far(n, 1e6f);
  std::vector<std::int32_t> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    const float from[3] = {origin[i].x, origin[i].y, origin[i].z};
    const float along[3] = {direction[i].x, direction[i].y, direction[i].z};
    for (int axis = 0; axis < 3; ++axis) {
      o[axis].push_back(from[axis]);
      d[axis].push_back(along[axis]);
    }
    order[i] = std::int32_t(i);
  }
  Hits h;
  for (auto* column : {&h.t, &h.ng_x, &h.ng_y, &h.ng_z, &h.u, &h.v}) column->resize(n);
  for (auto* column : {&h.geometry, &h.primitive, &h.is_visible}) column->resize(n);
  const RaySpan rays{o[0].data(), o[1].data(),   o[2].data(),  d[0].data(),      d[1].data(),
                     d[2].data(), t_near.data(), t_far.data(), is_active.data(), int(n)};
  const HitSpan hits{h.t.data(), h.ng_x.data(), h.ng_y.data(),     h.ng_z.data(),
                     h.u.data(), h.v.data(),    h.geometry.data(), h.primitive.data()};
  caster.closest_hits(rays, hits, width, Coherence::incoherent);
  const SegmentSpan segments{
      o[0].data(), o[1].data(), o[2].data(), d[0].data(), d[1].data(), d[2].data(), order.data(), int(n), 1};
  caster.unoccluded(segments, h.is_visible.data(), width, Coherence::incoherent);
  return h;
}

}  // namespace etendue::test

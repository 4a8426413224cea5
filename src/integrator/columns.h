// Numbers of a block of samples, one after the other: what stages load packets of lanes from, and store to.
#pragma once

#include "base/lane_vec.h"
#include "geometry/ray.h"
#include "geometry/raycast.h"
#include "light/receiver.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace etendue {

inline constexpr int block_capacity = 1024;

template <class T, int rows = block_capacity>
struct alignas(64) Column : std::array<T, std::size_t(rows)> {};

template <int rows>
struct Vec3ColumnOf {
  Column<float, rows> x, y, z;
};
template <int rows>
struct ColorColumnOf {
  Column<float, rows> r, g, b;
};
using Vec3Column = Vec3ColumnOf<block_capacity>;
using ColorColumn = ColorColumnOf<block_capacity>;

template <class F, int rows>
Vec3<F> load_lanes(const Vec3ColumnOf<rows>& column, int i) {
  return {load_lanes<F>(&column.x[i]), load_lanes<F>(&column.y[i]), load_lanes<F>(&column.z[i])};
}
template <class F, int rows>
void store_lanes(Vec3ColumnOf<rows>& column, int i, const Vec3<F>& v) {
  store_lanes(&column.x[i], v.x);
  store_lanes(&column.y[i], v.y);
  store_lanes(&column.z[i], v.z);
}
template <class F, int rows>
Color<F> load_lanes(const ColorColumnOf<rows>& column, int i) {
  return {load_lanes<F>(&column.r[i]), load_lanes<F>(&column.g[i]), load_lanes<F>(&column.b[i])};
}
template <class F, int rows>
void store_lanes(ColorColumnOf<rows>& column, int i, const Color<F>& c) {
  store_lanes(&column.r[i], c.r);
  store_lanes(&column.g[i], c.g);
  store_lanes(&column.b[i], c.b);
}

/// Rays as they are cast.
struct RayColumns {
  Vec3Column origin, direction;  ///< The direction is unit.
  Column<float> t_near, t_far;
  Column<std::int32_t> is_active;  ///< -1: cast it; 0: not.
};

/// What they hit; geometry -1: nothing.
struct HitColumns {
  Column<float> t, u, v;
  Vec3Column ng;  ///< Not normalised.
  Column<std::int32_t> geometry, primitive;
};

/// As the ray caster takes them. \param count of rays, whole packets
inline RaySpan span_of(const RayColumns& rays, int count) {
  return {rays.origin.x.data(),    rays.origin.y.data(),
          rays.origin.z.data(),    rays.direction.x.data(),
          rays.direction.y.data(), rays.direction.z.data(),
          rays.t_near.data(),      rays.t_far.data(),
          rays.is_active.data(),   count};
}
inline HitSpan span_of(HitColumns& hits) {
  return {hits.t.data(), hits.ng.x.data(), hits.ng.y.data(),     hits.ng.z.data(),
          hits.u.data(), hits.v.data(),    hits.geometry.data(), hits.primitive.data()};
}

/// The ray i, or the packet from i on; likewise below.
template <class F>
Ray<F> load_ray(const RayColumns& rays, int i) {
  return {load_lanes<F>(rays.origin, i), load_lanes<F>(rays.direction, i)};
}
template <class F>
Hit<F> load_hit(const HitColumns& hits, int i) {
  return {load_lanes<F>(&hits.t[i]),
          {load_lanes<F>(&hits.u[i]), load_lanes<F>(&hits.v[i])},
          load_lanes<F>(hits.ng, i),
          load_lanes<Int<F>>(&hits.geometry[i]),
          load_lanes<Int<F>>(&hits.primitive[i])};
}

struct ReceiverColumns {
  Vec3Column position, ng, ns;
  Column<std::int32_t> lit_sides, cut;
  const LightCuts* cuts = nullptr;
  const GlossyLobes* lobes = nullptr;  ///< Without them no material and no wo is stored.
  Column<std::int32_t> material;
  Vec3Column wo;
};
template <class F>
Receiver<F> load_receiver(const ReceiverColumns& receivers, int i) {
  Receiver<F> receiver{load_lanes<F>(receivers.position, i),
                       load_lanes<F>(receivers.ng, i),
                       load_lanes<F>(receivers.ns, i),
                       load_lanes<Int<F>>(&receivers.lit_sides[i]),
                       receivers.cuts,
                       load_lanes<Int<F>>(&receivers.cut[i]),
                       receivers.lobes};
  if (receivers.lobes) {
    receiver.material = load_lanes<Int<F>>(&receivers.material[i]);
    receiver.wo = load_lanes<F>(receivers.wo, i);
  }
  return receiver;
}
template <class F>
void store_receiver(ReceiverColumns& receivers, int i, const Receiver<F>& receiver) {
  store_lanes(receivers.position, i, receiver.position);
  store_lanes(receivers.ng, i, receiver.ng);
  store_lanes(receivers.ns, i, receiver.ns);
  store_lanes(&receivers.lit_sides[i], receiver.lit_sides);
  store_lanes(&receivers.cut[i], receiver.cut);
  receivers.cuts = receiver.cuts;
  receivers.lobes = receiver.lobes;
  if (receiver.lobes) {
    store_lanes(&receivers.material[i], receiver.material);
    store_lanes(receivers.wo, i, receiver.wo);
  }
}

}  // namespace etendue

// How much a cluster of lights may matter to a receiver: what a light tree chooses by.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "light/receiver.h"

#include <cstdint>

namespace etendue {

/// Facets of lights that are chosen as one at first: around them a sphere, around their normals a cone.
/// 64 bytes, one cache line.
struct alignas(64) LightCluster {
  Vec3f center;
  float radius_sq;
  Vec3f axis;                ///< Unit; of the cone of normals, from which each shines up to a right angle.
  float cos_normals;         ///< Of the cone's half angle; -1: every direction.
  float power;               ///< Relative to that of all lights with a place.
  std::int32_t first_child;  ///< The other stands behind it; 0: a leaf.
  std::int32_t parent;
  std::int32_t begin, end;  ///< Its facets, by their places in the tree.
};

template <class F>
struct ClusterLanes {
  Vec3<F> center, axis;
  F radius_sq, cos_normals, power;
};

/// The same one in every lane.
template <class F>
ClusterLanes<F> broadcast(const LightCluster& c) {
  return {{F(c.center.x), F(c.center.y), F(c.center.z)},
          {F(c.axis.x), F(c.axis.y), F(c.axis.z)},
          F(c.radius_sq),
          F(c.cos_normals),
          F(c.power)};
}
template <class F>
ClusterLanes<F> gather_clusters(const LightCluster* clusters, const Int<F>& which) {
  constexpr std::int32_t words = sizeof(LightCluster) / sizeof(float);
  const Int<F> at = which * Int<F>(words);
  const std::array<F, 4> sphere = gather_four(&clusters->center.x, at),
                         cone = gather_four(&clusters->axis.x, at);
  return {{sphere[0], sphere[1], sphere[2]},
          {cone[0], cone[1], cone[2]},
          sphere[3],
          cone[3],
          gather(&clusters->power, at)};
}

/// cos(max(0, a - b)) of two angles in [0, pi].
template <class F>
F cos_of_difference(const F& cos_a, const F& cos_b, const F& sin_b) {
  const F sin_a = sqrt(max(F(1) - cos_a * cos_a, F(0)));
  return select(cos_a >= cos_b, F(1), cos_a * cos_b + sin_a * sin_b);
}

template <class F>
struct Importance {
  F value;      ///< 1/m^2, as powers are relative.
  F spread_sq;  ///< The square of the sine of the angle between the cluster's centre and edge; 1 inside.
  Vec3<F> wi;   ///< To its centre, unit.
};

/// Power / distance^2 times the largest cosines that any place of the cluster can have at both ends (Conty
/// Estevez and Kulla 2018, "Importance sampling of many lights with adaptive tree splitting", eq. 3), with a
/// cosine at the receiver even where it scatters through. 0 only where nothing can arrive: cosines have
/// 1e-3 more than they need. Deviation: the distance to the centre is at least half of the sphere's radius.
template <class F>
Importance<F> importance(const ClusterLanes<F>& cluster, const Receiver<F>& receiver) {
  const Vec3<F> to_center = cluster.center - receiver.position;
  const F distance_sq = length_sq(to_center);
  const Mask<F> is_inside = mask_not(distance_sq > cluster.radius_sq);
  const F safe_distance_sq = select(is_inside, max(cluster.radius_sq, F(1e-37f)), distance_sq);
  const F inv_distance = F(1) / sqrt(safe_distance_sq);
  const F spread_sq = cluster.radius_sq * inv_distance * inv_distance;
  const F sin_spread = sqrt(spread_sq), cos_spread = sqrt(max(F(1) - spread_sq, F(0)));
  constexpr float slack = 1e-3f;

  const F cos_center = dot(to_center, receiver.ns) * inv_distance;
  const Int<F> sides = receiver.lit_sides, both(lit_side::front | lit_side::back);
  const F towards = select(equal(sides, both), abs(cos_center), cos_center);
  F cos_receiver = max(cos_of_difference(towards, cos_spread, sin_spread) + F(slack), F(0));
  cos_receiver = select(less(sides, Int<F>(lit_side::medium)), cos_receiver, F(1));

  const F cos_axis = -dot(to_center, cluster.axis) * inv_distance;
  const F sin_normals = sqrt(max(F(1) - cluster.cos_normals * cluster.cos_normals, F(0)));
  const F within_sphere = cos_of_difference(cos_axis, cos_spread, sin_spread);
  F cos_light = max(cos_of_difference(within_sphere, cluster.cos_normals, sin_normals) + F(slack), F(0));
  cos_light = select(cluster.cos_normals <= F(-1), F(1), cos_light);

  const F nearness = cluster.power / max(distance_sq, max(cluster.radius_sq * F(0.25f), F(1e-37f)));
  return {nearness * select(is_inside, F(1), cos_receiver * cos_light), min(spread_sq, F(1)),
          to_center * inv_distance};
}

}  // namespace etendue

// What pilots see of lights: a shadow ray from each.
#pragma once

#include "integrator/vertex.h"
#include "lightsampler/cluster_visibility.h"

#include <array>

namespace etendue {

/// Whether a packet of pilots sees a point of the facets that have been chosen. \param receiver of the vertex
/// \param u_place with what the choice has left, where on the facet
template <class F>
SeenLight<F> see_lights(const Scene& scene, const Vertex<F>& vertex, const Receiver<F>& receiver,
                        const Mask<F>& is_lit, const LightChoice<F>& choice, const UInt<F>& u_place) {
  const LightSample<F> sample =
      scene.lights.sample<F>(choice.light, F(1), receiver, {choice.u_left, u_place}, is_lit, choice.facet);
  const Mask<F> is_asked = mask_and(sample.is_there, mask_not(is_black(sample.radiance_over_pdf)));
  constexpr int lanes = lane_count_v<F>;
  alignas(64) std::array<float, lanes> origin_x, origin_y, origin_z, along_x, along_y, along_z;
  alignas(64) std::array<std::int32_t, lanes> order, is_free{};
  const Vec3<F> origin = vertex.origin_of_ray(sample.wi), along = sample.end - origin;
  store_lanes(origin_x.data(), origin.x);
  store_lanes(origin_y.data(), origin.y);
  store_lanes(origin_z.data(), origin.z);
  store_lanes(along_x.data(), along.x);
  store_lanes(along_y.data(), along.y);
  store_lanes(along_z.data(), along.z);
  store_mask<F>(order.data(), is_asked);
  for (int k = 0; k < lanes; ++k) order[std::size_t(k)] = order[std::size_t(k)] != 0 ? k : -1;
  scene.rays.unoccluded({origin_x.data(), origin_y.data(), origin_z.data(), along_x.data(), along_y.data(),
                         along_z.data(), order.data(), lanes, shadow_segment_end},
                        is_free.data(), lanes, Coherence::incoherent);
  return {is_asked, load_mask<F>(is_free.data())};
}

}  // namespace etendue

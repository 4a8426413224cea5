#include "integrator/single_sample.h"

#include "integrator/vertex.h"

namespace etendue {

Hit<float> closest_hit(const Scene& scene, const Ray<float>& ray, float t_near, float t_far) {
  Hit<float> hit{};
  const std::int32_t is_active = -1;
  scene.rays.closest_hits({&ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.direction.x, &ray.direction.y,
                           &ray.direction.z, &t_near, &t_far, &is_active, 1},
                          {&hit.t, &hit.ng.x, &hit.ng.y, &hit.ng.z, &hit.barycentric.x, &hit.barycentric.y,
                           &hit.geometry, &hit.primitive},
                          1, Coherence::incoherent);
  return hit;
}

bool is_visible(const Scene& scene, const Vec3f& a, const Vec3f& b) {
  const Vec3f along = b - a;
  const std::int32_t order = 0;
  std::int32_t is_free = 0;
  scene.rays.unoccluded({&a.x, &a.y, &a.z, &along.x, &along.y, &along.z, &order, 1, shadow_segment_end},
                        &is_free, 1, Coherence::incoherent);
  return is_free != 0;
}

}  // namespace etendue

// Rays one at a time, for what looks at single samples: replays, integrators of one's own.
#pragma once

#include "geometry/ray.h"
#include "scene/scene.h"

#include <limits>

namespace etendue {

/// What a ray hits first between t_near and t_far (m along it); geometry -1: nothing. A Vertex is made from
/// the two.
Hit<float> closest_hit(const Scene& scene, const Ray<float>& ray, float t_near = 0,
                       float t_far = std::numeric_limits<float>::infinity());

/// Whether nothing hides b from a, both in the world (m): by the segment between them but for its end, as
/// shadow rays go. `a` lies off its surface already (Vertex::origin_of_ray).
bool is_visible(const Scene& scene, const Vec3f& a, const Vec3f& b);

}  // namespace etendue

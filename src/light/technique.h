// How a light sample finds its place on the light that has been chosen.
#pragma once

namespace etendue {

/// Of polygons: the facets of meshes, and rectangles. Spheres are sampled by solid angle, disks by area,
/// whatever is asked for.
///   area: a point uniform on the surface, as the course handouts have it.
///   solid_angle: a direction uniform among those in which the receiver sees the polygon.
///   projected_solid_angle: a direction with density in proportion to the cosine at the receiver; where it
///   scatters
///     to both sides, or float cannot (ProjectedPolygon::is_accurate), by solid angle.
///   automatic: by area where the polygon is small for its distance, else by projected solid angle.
enum class LightTechnique { area, solid_angle, projected_solid_angle, automatic };

}  // namespace etendue

// A scene far from the origin, moved to it: floats there tell apart what they could not where the file has
// it.
#pragma once

#include "geometry/geometry.h"
#include "scenefile/scene_desc.h"

namespace etendue {

/// Whether floats gain from moving the middle of the scene to the origin: what is in it is small beside its
/// distance. \param shapes around all of them
bool is_far_from_origin(const Sphere& shapes);

/// The same scene with `origin` (m, world) moved to 0 0 0, in double precision: the camera, the shapes, media
/// and lights that have a place.
SceneDesc moved_to_origin(const SceneDesc& description, const Vec3<double>& origin);

/// Where the scene's camera is; 0 0 0 where it has none, or no transform.
Vec3<double> camera_place(const SceneDesc& description);

}  // namespace etendue

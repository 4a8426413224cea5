// Scenes of any size: made by formula, a terrain, 64 balls over it, four area lights; or any in fewer pixels.
#pragma once

#include "scene/scene.h"

namespace etendue::bench {

/// A displaced terrain of 2 grid^2 triangles and 64 balls of 2 (grid / 14 + 4)^2 each, diffuse and Phong by
/// turns, lit by 4 mesh lights of 32 triangles. grid 65: 17 thousand triangles; 700: 1.35 million. \param
/// has_normals whether the meshes have vertex normals
Scene terrain_scene(int grid, int width_px, int height_px, bool has_normals);

/// The same terrain under a swarm of square mesh lights that shine down, of one area together.
Scene swarm_scene(int light_count, int width_px, int height_px);

/// The same picture in fewer pixels.
void shrink(Camera& camera, int width_px);

}  // namespace etendue::bench

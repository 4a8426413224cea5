// SceneDesc -> Scene, and what the file asks for beside the scene itself.
#pragma once

#include "scene/scene.h"
#include "scene/scene_places.h"
#include "scenefile/scene_desc.h"

#include <string>
#include <vector>

namespace etendue {

/// A scene ready to render, with the parts of the file that the command line may override.
struct LoadedScene {
  Scene scene;
  ScenePlaces places;
  Object integrator;  ///< Unread until the render chooses; type empty where the file has none.
  int samples_per_pixel = 16;
  std::vector<std::string> warnings;  ///< Keys that nobody read, triangles without area ...
  double seconds_read = 0;   ///< All that is not seconds_build: meshes, textures, the lights' tables.
  double seconds_build = 0;  ///< Ray casting's tree.
};

/// What the file does not say.
struct LoadSettings {
  Edges edges = Edges::fast;
  std::vector<std::int32_t> lifted{};  ///< Ids of shapes that are moved along their fronts, by
  float lift = 0;                      ///< this much (m).
};

/// Reads the shapes, makes materials and lights, builds the ray caster. Throws InputError for
/// anything missing, repeated, unknown or degenerate: the message names the object and its place. A scene far
/// from the origin is moved there (Scene::origin).
LoadedScene load_scene(const SceneDesc& description, const LoadSettings& settings = {});

/// Throws InputError where `scene`, read from `description`, has no light: for integrators that need one.
void check_has_light(const SceneDesc& description, const Scene& scene);

}  // namespace etendue

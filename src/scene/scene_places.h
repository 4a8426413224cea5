// Where the objects of a scene stand in its file, and what they are called: for messages.
#pragma once

#include "base/error.h"

#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// One row an object, by the ids that the scene's own tables have.
struct ScenePlaces {
  struct Shape {
    Location where;
    std::string name;     ///< With its kind: "mesh 'lamp'", "rectangle 3".
    bool is_turned_over;  ///< A mesh without vertex normals whose transform is a mirror image.
  };
  struct Light {
    Location where;
    std::string name;
  };

  Location scene, camera;
  std::optional<Location> far_clip;  ///< Where the file states it.
  std::vector<Shape> shapes;         ///< By geometry.
  std::vector<Light> lights;
  std::vector<Location> materials;  ///< The first description of each; of the default, its first shape.
};

}  // namespace etendue

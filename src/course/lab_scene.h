// The scene of three Phong plates and four lights with other plates and other lights.
#pragma once

#include "scenefile/scene_desc.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// What the lab changes of the scene.
struct LabChange {
  double exponent_factor;  ///< Of all Phong exponents, above 0.
  double size_factor;      ///< Of the lights' radii, above 0; their power stays.
  int width, height;       ///< Pixels.
};

/// The same scene, changed; its samples are independent, so that N of them have an N-th of the variance of
/// one.
SceneDesc changed_plates(SceneDesc description, const LabChange& change);

/// Ids of the shapes that are Phong plates, in the order of the file. Each mesh must be one shape.
std::vector<std::int32_t> plate_shapes(const SceneDesc& description);

}  // namespace etendue

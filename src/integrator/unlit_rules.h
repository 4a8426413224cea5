// What the integrators that need no lights of the scene are told.
#pragma once

#include "base/color.h"
#include "base/vec.h"

#include <limits>

namespace etendue {

struct ShowNormals {};
struct ShowMaterial {};

struct VisibilityRules {
  bool is_cosine_weighted = false;                        ///< Otherwise every direction counts alike.
  float length = std::numeric_limits<float>::infinity();  ///< Nothing farther hides the sky (m).
  float background = 0;                                   ///< What the camera sees beside all shapes.
};

struct SimpleLight {
  Vec3f position{0, 0, 0};  ///< World, m.
  Colorf energy{1, 1, 1};   ///< Its power, W.
};

}  // namespace etendue

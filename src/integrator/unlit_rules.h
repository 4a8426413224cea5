// What the integrators that are told of no light of the scene are told.
#pragma once

#include "base/color.h"
#include "base/vec.h"
#include "geometry/ray.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

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

/// What a sample's random numbers are a function of: see sample_2d.
struct SampleStream {
  std::uint32_t lo, hi, index;
};

struct CameraSample {
  Ray<float> ray;
  float t_near, t_far;  ///< The clip planes, m along the ray.
  SampleStream stream;
};

/// A function of one camera ray at a time, that knows the scene by itself. Called from many threads.
struct SingleRays {
  std::string plugin;                                   ///< Where it comes from: a file and a hash.
  std::function<Colorf(const CameraSample&)> radiance;  ///< One sample of it, W/(m^2 sr).
};

}  // namespace etendue

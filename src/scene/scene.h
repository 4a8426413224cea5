// The immutable whole that is rendered: tables and indices.
#pragma once

#include "bsdf/bsdf.h"
#include "film/filter.h"
#include "geometry/camera.h"
#include "geometry/geometry.h"
#include "geometry/raycast.h"
#include "light/light.h"
#include "medium/homogeneous.h"
#include "sampler/sampler.h"
#include "scene/lamp_outlines.h"

#include <optional>

namespace etendue {

struct Scene {
  Vec3<double> origin{0, 0, 0};  ///< In the file's world (m): what the scene itself has at 0 0 0.
  Camera camera;
  PixelFilter filter;
  Geometry geometry;
  RayCaster rays;  ///< Over `geometry`.
  Materials materials;
  Lights lights;
  std::optional<HomogeneousMedium> medium;
  SamplerKind sampler;
  LampOutlines lamp_outlines{};  ///< Of `camera` and `filter`.
};

}  // namespace etendue

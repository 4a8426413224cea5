// One sample again, on its own: what it computed at each stage, to see where a bad value came from.
#pragma once

#include "render/render.h"

#include <cstdint>
#include <optional>

namespace etendue {

/// Which sample of an image.
struct SampleId {
  int x, y;                       ///< Pixel, from the upper left.
  std::int64_t replicate, index;  ///< The index counts within the replicate.
};

/// What one sample computed, in the order of computing. Lengths in m, radiance in W/(m^2 sr), directions
/// unit.
struct SampleTrace {
  struct Hit {
    Vec3f position, ng, ns;
    std::int32_t geometry, primitive, material, light;  ///< light -1: it is none.
  };
  struct LightSample {
    std::int32_t light;
    Vec3f position;  ///< On the light.
    Colorf radiance_over_pdf;
    float pdf_solid_angle;  ///< 1/sr, the choice of the light included; 0: the light faces away.
    Colorf unshadowed;      ///< What it adds where nothing hides it: BSDF, cosine and weight included.
    bool is_shadow_ray_cast, is_visible;
  };
  struct BsdfSample {
    bool is_ray_cast;  ///< Not where the sample reflects nothing.
    Vec3f direction;
    Colorf throughput;      ///< f cos / pdf
    float pdf_solid_angle;  ///< 1/sr
    float distance;         ///< To what the ray hits; infinite where that is nothing.
    std::int32_t light;     ///< That it hits; -1: none.
  };

  float x_px, y_px;  ///< On the film, in pixels from the upper left.
  Vec3f ray_origin, ray_direction;
  std::optional<Hit> hit;                   ///< What the camera sees.
  Colorf emission;                          ///< That the camera sees.
  std::optional<LightSample> light_sample;  ///< Where the integrator takes one and there is a surface.
  std::optional<BsdfSample> bsdf_sample;    ///< Likewise.
  Colorf radiance;  ///< The sample's, as computed: not finite or negative where that is what went wrong.
};

/// Runs this one sample with one lane, as the scalar kernel does: to the same bits. Throws InputError for a
/// sample that a render with these settings does not have.
SampleTrace replay(const Scene& scene, const RenderSettings& settings, const SampleId& sample);

}  // namespace etendue

// One sample again, on its own: what it computed at each stage, to see where a bad value came from.
#pragma once

#include "render/render.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// Which sample of an image.
struct SampleId {
  int x, y;                       ///< Pixel, from the upper left.
  std::int64_t replicate, index;  ///< The index counts within the replicate.
};

/// What one sample computed, in the order of computing. Lengths in m, radiance in W/(m^2 sr), directions
/// unit.
struct SampleTrace {
  struct Surface {
    Vec3f ng, ns;
    std::int32_t geometry, primitive, material, light;  ///< light -1: it is none.
  };
  struct LightSample {
    std::int32_t light;
    Vec3f end;  ///< Of the shadow segment: on the light, or beyond the scene.
    Colorf radiance_over_pdf;
    float
        pdf_solid_angle;  ///< 1/sr, the choice of the light included; 0: no sample. Infinite: a Dirac delta.
    Colorf unshadowed;    ///< What it adds where nothing hides it: BSDF, cosine, weight and path included.
    bool is_shadow_ray_cast, is_visible;
    struct Hider {
      std::int32_t geometry, primitive;
    };
    std::optional<Hider> hidden_by;  ///< The first thing on the shadow ray's way, where there is one.
  };
  struct BsdfSample {
    bool is_followed;  ///< Not where nothing is scattered, or where roulette ended the path.
    Vec3f direction;
    Colorf throughput;      ///< Of the path, with it.
    float pdf_solid_angle;  ///< 1/sr; infinite: a Dirac delta; 0: direct light is left to light samples.
  };
  /// A place that the path came to.
  struct Vertex {
    int number;  ///< 0: the first that the camera ray meets.
    int branch;  ///< Where several BSDF samples leave vertex 0: which of them.
    enum class Kind { surface, medium, nothing } kind;
    Vec3f position;  ///< Not of nothing.
    std::optional<Surface> surface;
    std::optional<LightSample> light_sample;  ///< The last, where the integrator takes several.
    std::optional<BsdfSample> bsdf_sample;    ///< Of this branch.
    Colorf radiance;                          ///< Of the path, up to and with this vertex.
  };

  float x_px, y_px;  ///< On the film, in pixels from the upper left.
  Vec3f ray_origin, ray_direction;
  std::vector<Vertex> vertices;  ///< Of integrators that trace paths.
  Colorf radiance;  ///< The sample's, as computed: negative or not finite where that is what went wrong.
};

/// Runs this one sample with one lane, as the scalar kernel does: to the same bits. Throws InputError for a
/// sample that a render with these settings does not have.
SampleTrace replay(const Scene& scene, const RenderSettings& settings, const SampleId& sample);

}  // namespace etendue

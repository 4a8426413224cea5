// Small squares of pixels, here and there in the image, which pilots render to decide how the rest is.
#pragma once

#include "lightsampler/light_cuts.h"
#include "render/render.h"
#include "render/work_unit.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// Images of fewer pixels are not worth a pilot.
inline constexpr double fewest_pixels_for_pilots = 1 << 16;

/// What a render has in common with pilots of it: replicates are scramblings, and the seed is one that no
/// image has, the same for all seeds, so that what pilots tell is too. No layers.
RenderSettings pilot_settings(const RenderSettings& settings, std::uint64_t seed);

/// Squares of 2 x 2 pixels, spread evenly over an image of that size, each in a tile of its own that lights
/// are chosen for; `count`, or as many as there is room for.
std::vector<PixelRectangle> pilot_squares(int width_px, int height_px, int count);

class PilotSquares {
 public:
  static constexpr int side_px = 2, pixels = side_px * side_px;  ///< Of a square.

  struct Rendering {
    std::vector<Color<double>> means;  ///< Of all replicates of all pixels, one pixel after the other.
    RenderCounts counts;
  };

  /// `count` of pilot_squares. \param scene must outlive it \param settings name the light sampler of all
  /// renders
  PilotSquares(const Scene& scene, const RenderSettings& settings, int count);

  /// None where it was stopped. The number of threads changes nothing.
  std::optional<Rendering> render(const RenderSettings& settings, int replicates, int samples_per_replicate,
                                  const StopRequest* stop);

 private:
  const Scene& scene_;
  std::vector<PixelRectangle> squares_;
  LightSampler light_sampler_;
  LightCutStore cuts_;
};

}  // namespace etendue

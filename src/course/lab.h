// Directional against area sampling, tried out: the plates rendered with other roughness, lights and samples
// by each method, and how noisy each light is on each plate.
#pragma once

#include "image/image_file.h"
#include "render/render.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace etendue {

/// What is rendered: all combinations.
struct LabGrid {
  std::vector<double> exponent_factors, size_factors;  ///< LabChange.
  std::vector<int> samples;                            ///< A pixel, from few to many.
  int width, height;                                   ///< Pixels.
};

/// \param is_quick few and small pictures, to see that it works; each slider still has two places
LabGrid lab_grid(bool is_quick);

/// In the order of the pictures: light sampling, BSDF sampling, their average, multiple importance sampling.
inline constexpr std::string_view lab_methods[]{"light", "direct", "average", "mis"};

/// Of one exponent factor, size factor and method.
struct LabNoise {
  /// By plate, then light: the root mean square, over the plate's pixels, of the standard deviation of one
  /// sample of the light's green radiance, over its mean there; NaN where too few samples met the light to
  /// tell.
  std::vector<std::vector<double>> relative;
};

/// Exponent factors outermost, then size factors, then (pictures only) samples, then methods.
struct Lab {
  std::vector<Image> pictures;
  std::vector<LabNoise> noise;
};

/// \param progress takes what is done, in [0, 1]
/// \return nothing where it was stopped. Throws InputError where the scene cannot be read.
std::optional<Lab> render_lab(const std::filesystem::path& scene, const LabGrid& grid, int threads, Isa isa,
                              const std::function<void(double)>& progress, const StopRequest& stop);

}  // namespace etendue

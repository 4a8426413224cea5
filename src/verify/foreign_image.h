// An image that another renderer has made: its noise, and what may have been done to it on its way here.
#pragma once

#include "verify/moment_image.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct ForeignImage {
  MomentImage image;              ///< Luminance; `variance` NaN until it is known.
  std::vector<char> is_readable;  ///< Of each pixel: neither a NaN nor, in a file of 8 bits, at its white.
  bool is_8_bit = false;
  std::string noise{};  ///< Where the variances come from: "its layer stderr". Empty: not known.
  std::string hint{};   ///< What would make it known, though the file alone does not.
};

struct ForeignFiles {
  std::filesystem::path image, standard_errors{};  ///< The second may be empty.
  std::optional<int> samples_per_pixel{};          ///< That the image was rendered with.
};

/// EXR, PNG, JPEG or Radiance HDR. The noise is that of the image of standard errors where named; else of the
/// EXR's layer stderr.R, stderr.G, stderr.B, or variance.*; else, with the samples a pixel known, of a layer
/// that holds the variance of one sample (Variance.*, of pbrt) or its second moment (m2_NAME.*, of Mitsuba's
/// moment integrator). Throws InputError for a file that cannot be read, or whose size is not the one asked
/// for.
ForeignImage read_foreign_image(const ForeignFiles& files, int width, int height);

/// Where its noise is not known: takes what the image differs by from `reference`, pixel beside pixel, beyond
/// the reference's own noise, for noise, and says so.
void estimate_noise(ForeignImage& foreign, const MomentImage& reference);

/// What was done to the image, as far as `reference` tells: "it is 0.5 times as bright", "it is upside down".
/// None where none of the usual explains the difference.
std::optional<std::string> likely_mishap(const ForeignImage& foreign, const MomentImage& reference);

}  // namespace etendue

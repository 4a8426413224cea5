// Do the estimators of a scene agree: renders them all, tests them in pairs, says which of them is alone.
#pragma once

#include "scene/load_scene.h"
#include "verify/compare.h"
#include "verify/estimators.h"
#include "verify/foreign_image.h"
#include "verify/light_differences.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct VerifySettings {
  std::optional<int> samples_per_pixel;  ///< Of each estimator; rounded up to a multiple of its replicates.
  double seconds = 60;                   ///< For all, where no number of samples is given.
  double level = 1e-3;                   ///< How often a correct scene may raise an alarm.
  std::uint64_t seed = 0;
  int threads = 0;
  Isa isa = Isa::scalar;
  const ForeignImage* against = nullptr;  ///< One more, that another renderer has made.
  std::string against_name{};
};

/// An estimator, or the image of another renderer, and what it has come to.
struct VerifiedEstimator {
  Estimator estimator;
  ComparedImage image;
  int samples_per_pixel = 0, replicates = 0;
  double mean = 0, standard_error = 0;  ///< Of the whole image (luminance, W/(m^2 sr)).
  double seconds = 0;
  std::int64_t invalid_samples = 0;
  bool is_odd = false;             ///< It differs from those that agree with each other.
  bool can_tell = false;           ///< With at least one other.
  double smallest_difference = 0;  ///< Relative to the mean, beside the other that tells most.
  bool is_foreign = false;         ///< Another renderer's image.
};

enum class Verdict { agree, differ, cannot_tell };

struct VerifiedPair {
  std::size_t a, b;  ///< Of the estimators.
  Comparison comparison;
  double p_value = 1;  ///< Of the whole run (Holm).
  Verdict verdict = Verdict::agree;
  std::vector<LightDifference> lights{};  ///< Whose light differs, where that was looked for.
};

struct VerifyResult {
  std::vector<VerifiedEstimator> estimators;
  std::vector<LeftOutEstimator> left_out;
  std::vector<VerifiedPair> pairs;
  Verdict verdict = Verdict::agree;  ///< cannot_tell: no two can.
  double level = 1e-3;
  /// Relative to the image's mean: between the two that tell most, found with probability 0.9.
  double smallest_difference = 0;
  std::string foreign_noise{};               ///< Where the noise of the other renderer's image is from.
  std::string foreign_hint{};                ///< How it would be known better; mostly empty.
  std::int64_t foreign_pixels_left_out = 0;  ///< Not numbers, or white in 8 bits.
  std::optional<std::string> mishap{};       ///< What may have been done to it, where it differs.
  bool is_interrupted = false;               ///< Only the estimators before the stop are there.
};

/// \param fraction of the work done, in [0, 1]
using VerifyProgress = std::function<void(double fraction)>;

/// Throws InputError where the settings do not fit the scene.
VerifyResult verify(const Scene& scene, const Estimators& estimators, const VerifySettings& settings,
                    const VerifyProgress& progress = {}, const StopRequest* stop = nullptr);

}  // namespace etendue

#include "render/check_settings.h"

#include "base/error.h"

#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <string>

namespace etendue {

namespace {

/// Numbers that would do in place of these two.
std::string advice(int samples, int replicates) {
  const std::int64_t more = (samples / replicates + 1) * std::int64_t(replicates);
  const std::string divide = fmt::format("choose a number of replicates that divides {}", samples);
  return more > std::numeric_limits<int>::max() ? divide
                                                : fmt::format("{}, or take {} samples a pixel", divide, more);
}

/// Samples of a pixel, and those of one vertex of each, are numbered by 32 bits.
constexpr std::int64_t most_numbers = std::int64_t(1) << 32;

/// The most that a sample takes of light samples, or of BSDF samples, at one vertex.
std::int64_t numbers_of_sample(const IntegratorSettings& integrator) {
  const PathRules* rules = integrator.path_rules();
  return rules ? rules->most_samples() : 1;
}

}  // namespace

void check_settings(const RenderSettings& settings) {
  if (settings.samples_per_pixel < 1)
    throw InputError(fmt::format("{} samples a pixel; at least 1 is needed", settings.samples_per_pixel));
  const int replicates = settings.replicate_count();
  if (replicates < 1) throw InputError(fmt::format("{} replicates; at least 1 is needed", replicates));
  if (!settings.allocation && settings.samples_per_pixel % replicates != 0)
    throw InputError(fmt::format("{} samples a pixel cannot be split into {} equal replicates\n{}",
                                 settings.samples_per_pixel, replicates,
                                 advice(settings.samples_per_pixel, replicates)));
  const std::int64_t of_sample = numbers_of_sample(settings.integrator);
  const std::int64_t numbers = settings.samples_per_pixel * of_sample;
  if (numbers > most_numbers)
    throw InputError(
        fmt::format("{} samples a pixel with {} light samples, BSDF samples or camera rays each are {}, "
                    "more than the 4294967296 that can be told apart; take fewer of one of them",
                    settings.samples_per_pixel, of_sample, numbers));
}

std::int64_t most_samples_of_pixel(const IntegratorSettings& integrator) {
  return most_numbers / 4 / numbers_of_sample(integrator);
}

}  // namespace etendue

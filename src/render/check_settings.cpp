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
  // Samples of a pixel, and those of one vertex of each, are numbered by 32 bits.
  const PathRules* rules = settings.integrator.path_rules();
  const std::int64_t numbers = std::int64_t(settings.samples_per_pixel) * (rules ? rules->most_samples() : 1);
  if (numbers > std::int64_t(1) << 32)
    throw InputError(
        fmt::format("{} samples a pixel with {} light or BSDF samples each are {}, more than "
                    "the 4294967296 that can be told apart; take fewer of one of them",
                    settings.samples_per_pixel, rules->most_samples(), numbers));
}

}  // namespace etendue

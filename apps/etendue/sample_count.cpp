#include "sample_count.h"

#include "interrupt.h"
#include "messages.h"

#include <algorithm>
#include <fmt/format.h>

namespace etendue::app {

std::optional<ErrorGoal> error_goal(const RenderOptions& options) {
  if (!options.relative_error) return std::nullopt;
  return ErrorGoal{*options.relative_error, options.share_within, options.confidence};
}

std::optional<Pilot> settle_samples(const RenderOptions& options, const Scene& scene,
                                    RenderSettings& settings) {
  const std::optional<ErrorGoal> goal = error_goal(options);
  if (!goal && !options.seconds) return std::nullopt;
  if (options.samples_per_pixel && *options.samples_per_pixel < least_pilot_samples)
    throw InputError(
        fmt::format("--spp {} with --error: it is the most there may be, and pilots alone take {}",
                    *options.samples_per_pixel, least_pilot_samples));
  // Samples of a pixel, and those of one vertex of each, are numbered by 32 bits.
  const PathRules* rules = settings.integrator.path_rules();
  const std::int64_t numbers = (std::int64_t(1) << 30) / (rules ? rules->most_samples() : 1);
  const int most = int(std::min<std::int64_t>(numbers, options.samples_per_pixel.value_or(1 << 16)));
  if (!options.is_quiet) say("pilots find out how many samples a pixel that takes ...\n");
  const Pilot pilot = goal ? samples_for_error(scene, settings, *goal, most, &stop_request)
                           : samples_for_time(scene, settings, *options.seconds, most, &stop_request);
  if (pilot.is_interrupted) return pilot;
  settings.samples_per_pixel = pilot.samples_per_pixel;
  if (options.is_quiet) return pilot;
  say("pilots of {:.1f} s ask for {} samples a pixel{}\n", pilot.seconds, settings.samples_per_pixel,
      pilot.is_dark    ? ": they have met no light"
      : !pilot.is_most ? ""
      : goal           ? ", the most there may be: what was asked for is not reached"
                       : ", the most there may be: the time is not used up");
  return pilot;
}

}  // namespace etendue::app

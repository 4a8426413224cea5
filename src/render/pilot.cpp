#include "render/pilot.h"

#include "base/error.h"
#include "base/hash.h"
#include "render/check_settings.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <numeric>
#include <optional>
#include <vector>

namespace etendue {
namespace {

constexpr double largest_growth = 8;  // From one pilot to the next, and from the last to the image.

/// Up to a number of which default_replicates() makes few: a multiple of a power of two.
int rounded_up(double samples, int most) {
  const double wanted = std::clamp(samples, double(least_pilot_samples), double(most));
  const auto step = int(std::max(8u, std::bit_ceil(std::uint32_t(wanted) / 32)));
  return std::max(least_pilot_samples, std::min(int(std::ceil(wanted / step)), most / step) * step);
}

/// With random numbers of its own, as `purpose` says.
RenderResult render_with(const Scene& scene, const RenderSettings& settings, int samples,
                         std::uint64_t purpose, const StopRequest* stop) {
  RenderSettings of_pilot = settings;
  of_pilot.samples_per_pixel = samples;
  of_pilot.replicates.reset();
  of_pilot.layers.clear();
  of_pilot.noise_parts.reset();
  of_pilot.seed = hash64(settings.seed ^ hash64(purpose));
  return render(scene, of_pilot, {}, stop);
}

RenderResult render_pilot(const Scene& scene, const RenderSettings& settings, int samples, Pilot& pilot,
                          const StopRequest* stop) {
  RenderResult result = render_with(scene, settings, samples, std::uint64_t(samples), stop);
  pilot.samples += result.counts.samples;
  pilot.seconds += result.seconds;
  pilot.is_interrupted = result.is_interrupted;
  return result;
}

/// How far one of two pilots is from the goal; nothing where they were interrupted.
std::optional<DistanceFromGoal> distance_of_pilots(const Scene& scene, const RenderSettings& settings,
                                                   int samples, const ErrorGoal& goal, Pilot& pilot,
                                                   const StopRequest* stop) {
  RenderSettings of_second = settings;
  of_second.seed = hash64(settings.seed + 1);
  const RenderResult a = render_pilot(scene, settings, samples, pilot, stop);
  if (pilot.is_interrupted) return std::nullopt;
  const RenderResult b = render_pilot(scene, of_second, samples, pilot, stop);
  if (pilot.is_interrupted) return std::nullopt;
  pilot.is_dark = luminance(a.film.mean()) == 0 && luminance(b.film.mean()) == 0;
  const std::vector<PixelInterval> intervals_a = pixel_intervals(a.film, a.luminances, goal.confidence),
                                   intervals_b = pixel_intervals(b.film, b.luminances, goal.confidence);
  return distance_from({a.film, b.film, intervals_a, intervals_b}, goal);
}

}  // namespace

Pilot samples_for_error(const Scene& scene, const RenderSettings& settings, const ErrorGoal& goal, int most,
                        const StopRequest* stop) {
  constexpr double of_independent = -0.5, of_nets = -0.75;
  Pilot pilot;
  double power = of_independent, factor_before = 0;
  for (int samples = least_pilot_samples, samples_before = 0;;) {
    const std::optional<DistanceFromGoal> distance =
        distance_of_pilots(scene, settings, samples, goal, pilot, stop);
    if (!distance) return pilot;
    pilot.bars_over_errors = distance->bars_over_errors;
    if (pilot.is_dark && samples > least_pilot_samples) {
      pilot.samples_per_pixel = samples;
      return pilot;
    }
    if (std::isfinite(factor_before) && factor_before > 0 && distance->factor > 0) {
      const double measured =
          std::log(distance->factor / factor_before) / std::log(double(samples) / samples_before);
      power = (of_independent + std::clamp(measured, of_nets, of_independent)) / 2;
    }
    const double needed = samples * std::pow(distance->factor, -1 / power);
    pilot.samples_per_pixel = rounded_up(needed, most);
    pilot.is_most = needed > pilot.samples_per_pixel;
    if (pilot.samples_per_pixel <= largest_growth * samples) return pilot;
    samples_before = samples;
    factor_before = distance->factor;
    samples = rounded_up(std::min(samples * largest_growth, pilot.samples_per_pixel / largest_growth), most);
  }
}

Pilot samples_for_time(const Scene& scene, const RenderSettings& settings, double seconds, int most,
                       const StopRequest* stop) {
  constexpr double share_of_pilot = 0.05, reserve = 0.97;
  Pilot pilot;
  for (int samples = least_pilot_samples;;) {
    const double before = pilot.seconds;
    render_pilot(scene, settings, samples, pilot, stop);
    if (pilot.is_interrupted) return pilot;
    const double of_sample = (pilot.seconds - before) / samples;
    const double left = reserve * seconds - pilot.seconds;
    // A little less, as numbers are rounded up.
    const double possible = left / of_sample / 1.03;
    pilot.samples_per_pixel = rounded_up(possible, most);
    pilot.is_most = possible > most;
    if (pilot.seconds >= share_of_pilot * seconds || samples >= most / 2) return pilot;
    samples = rounded_up(std::min(samples * largest_growth, share_of_pilot * seconds / of_sample), most / 2);
  }
}

AllocationPilot allocation_for(const Scene& scene, const RenderSettings& settings, const StopRequest* stop) {
  constexpr std::uint64_t purpose = 0x5ca1ab1e;
  constexpr int least = 4, most = 32;
  constexpr double confidence = 0.95;
  constexpr float share_of_mean = 0.25f;
  const int samples = settings.samples_per_pixel;
  AllocationPilot pilot;
  pilot.replicates = settings.replicates.value_or(default_replicates(int(std::bit_floor(unsigned(samples)))));
  pilot.samples_per_pixel = std::clamp(int(std::bit_floor(unsigned(samples) / 8)), least, most);
  const int left = samples - pilot.samples_per_pixel;
  if (samples < least_pilot_samples || left < pilot.replicates)
    throw InputError(fmt::format(
        "{} samples a pixel, of which a pilot takes {}, are too few to be shared among pixels of {} "
        "replicates; at least {} are needed",
        samples, pilot.samples_per_pixel, pilot.replicates,
        std::max(least_pilot_samples, pilot.replicates + (pilot.replicates + 6) / 7)));
  const RenderResult result = render_with(scene, settings, pilot.samples_per_pixel, purpose, stop);
  pilot.seconds = result.seconds;
  if (result.is_interrupted) return pilot;
  std::vector<float> widths;
  for (const PixelInterval& interval : pixel_intervals(result.film, result.luminances, confidence))
    widths.push_back(interval.rule == IntervalRule::black ? 0 : interval.luminance_half_width);
  const float everywhere =
      share_of_mean * float(std::accumulate(widths.begin(), widths.end(), 0.0) / double(widths.size()));
  for (float& width : widths) width += everywhere;
  const std::int64_t most_of_replicate =
      std::max<std::int64_t>(most_samples_of_pixel(settings.integrator) / pilot.replicates, 1);
  pilot.allocation = allocate(result.film.width(), widths, double(left) / pilot.replicates,
                              int(std::bit_floor(std::uint64_t(most_of_replicate))));
  return pilot;
}

}  // namespace etendue

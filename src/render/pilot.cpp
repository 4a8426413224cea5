#include "render/pilot.h"

#include "base/hash.h"
#include "film/pixel_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace etendue {
namespace {

constexpr int least_samples = 16, step = 8;  // A multiple of 8 has 8 replicates.
constexpr double largest_growth = 8;         // From one pilot to the next, and from the last to the image.

int rounded_up(double samples, int most) {
  const double steps = std::ceil(samples / step);
  return std::max(least_samples, int(std::min(steps * step, double(most / step * step))));
}

RenderResult render_pilot(const Scene& scene, const RenderSettings& settings, int samples, Pilot& pilot,
                          const StopRequest* stop) {
  RenderSettings of_pilot = settings;
  of_pilot.samples_per_pixel = samples;
  of_pilot.replicates.reset();
  of_pilot.layers.clear();
  of_pilot.seed = hash64(settings.seed ^ hash64(std::uint64_t(samples)));
  RenderResult result = render(scene, of_pilot, {}, stop);
  pilot.samples += result.counts.samples;
  pilot.seconds += result.seconds;
  pilot.is_interrupted = result.is_interrupted;
  return result;
}

/// Of each rendered pixel: half-width over what the goal allows; more than 1 in an image that met no light.
std::vector<double> over_goal(const RenderResult& result, const ErrorGoal& goal) {
  const std::vector<PixelInterval> intervals =
      pixel_intervals(result.film, result.luminances, goal.confidence);
  const double floor = 0.01 * luminance(result.film.mean());
  std::vector<double> ratios;
  for (int y = 0; y < result.film.height(); ++y)
    for (int x = 0; x < result.film.width(); ++x) {
      const PixelInterval& interval =
          intervals[std::size_t(y) * std::size_t(result.film.width()) + std::size_t(x)];
      if (interval.rule == IntervalRule::unknown) continue;
      const double allowed = goal.relative * std::max(luminance(result.film.at(x, y).mean), floor);
      const bool is_reached =
          floor > 0 && (interval.rule == IntervalRule::black || interval.luminance_half_width == 0);
      ratios.push_back(is_reached  ? 0
                       : floor > 0 ? interval.luminance_half_width / allowed
                                   : std::numeric_limits<double>::infinity());
    }
  return ratios;
}

}  // namespace

double share_within(const RenderResult& result, const ErrorGoal& goal) {
  const std::vector<double> ratios = over_goal(result, goal);
  const auto within = std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio <= 1; });
  return ratios.empty() ? 0 : double(within) / double(ratios.size());
}

Pilot samples_for_error(const Scene& scene, const RenderSettings& settings, const ErrorGoal& goal, int most,
                        const StopRequest* stop) {
  Pilot pilot;
  for (int samples = least_samples;;) {
    const RenderResult result = render_pilot(scene, settings, samples, pilot, stop);
    if (pilot.is_interrupted) return pilot;
    std::vector<double> ratios = over_goal(result, goal);
    const auto of_share =
        ratios.begin() +
        std::clamp<std::ptrdiff_t>(std::ptrdiff_t(std::ceil(goal.share * double(ratios.size()))) - 1, 0,
                                   std::ptrdiff_t(ratios.size()) - 1);
    std::nth_element(ratios.begin(), of_share, ratios.end());
    const double needed = samples * *of_share * *of_share;
    pilot.samples_per_pixel = rounded_up(needed, most);
    if (pilot.samples_per_pixel <= largest_growth * samples) return pilot;
    samples = rounded_up(std::min(samples * largest_growth, pilot.samples_per_pixel / largest_growth), most);
  }
}

Pilot samples_for_time(const Scene& scene, const RenderSettings& settings, double seconds, int most,
                       const StopRequest* stop) {
  constexpr double share_of_pilot = 0.05, reserve = 0.97;
  Pilot pilot;
  for (int samples = least_samples;;) {
    const double before = pilot.seconds;
    render_pilot(scene, settings, samples, pilot, stop);
    if (pilot.is_interrupted) return pilot;
    const double of_sample = (pilot.seconds - before) / samples;
    const double left = reserve * seconds - pilot.seconds;
    pilot.samples_per_pixel = rounded_up(std::max(0.0, left / of_sample - step + 1), most);
    if (pilot.seconds >= share_of_pilot * seconds || samples >= most / 2) return pilot;
    samples = rounded_up(std::min(samples * largest_growth, share_of_pilot * seconds / of_sample), most / 2);
  }
}

}  // namespace etendue

#include "render/pilot.h"

#include "base/error.h"
#include "base/hash.h"
#include "film/needed_samples.h"
#include "render/check_settings.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace etendue {
namespace {

constexpr double largest_growth = 8;  // From one pilot to the next, and from the last to the image.
constexpr double power_of_independent = -0.5, steepest_power = -0.75;  // Of samples, by which errors fall.

/// Half-way between what was measured and the root, as nets gain less the more of them there are.
double expected_power(double measured) {
  return (power_of_independent + std::clamp(measured, steepest_power, power_of_independent)) / 2;
}

/// Up to a number of which default_replicates() makes few: a multiple of a power of two.
int rounded_up(double samples, int most) {
  const double wanted = std::clamp(samples, double(least_pilot_samples), double(most));
  const auto step = int(std::max(8u, std::bit_ceil(std::uint32_t(wanted) / 32)));
  return std::max(least_pilot_samples, std::min(int(std::ceil(wanted / step)), most / step) * step);
}

/// Of `settings` with random numbers of its own, as `purpose` says.
RenderResult render_with(const Scene& scene, RenderSettings settings, std::uint64_t purpose,
                         const StopRequest* stop) {
  settings.layers.clear();
  settings.noise_parts.reset();
  settings.seed = hash64(settings.seed ^ hash64(purpose));
  return render(scene, settings, {}, stop);
}

RenderSettings with_samples(RenderSettings settings, int samples) {
  settings.samples_per_pixel = samples;
  settings.replicates.reset();
  return settings;
}

RenderResult render_pilot(const Scene& scene, const RenderSettings& settings, std::uint64_t purpose,
                          Pilot& pilot, const StopRequest* stop) {
  RenderResult result = render_with(scene, settings, purpose, stop);
  pilot.samples += result.counts.samples;
  pilot.seconds += result.seconds;
  pilot.is_interrupted = result.is_interrupted;
  return result;
}

/// Two renders, and what `distance` makes of them; nothing where they were interrupted.
template <class Distance>
auto distance_of_pilots(const Scene& scene, const RenderSettings& settings, std::uint64_t purpose,
                        const ErrorGoal& goal, Pilot& pilot, const StopRequest* stop, Distance&& distance)
    -> std::optional<decltype(distance(std::declval<RenderedTwice>()))> {
  RenderSettings of_second = settings;
  of_second.seed = hash64(settings.seed + 1);
  const RenderResult a = render_pilot(scene, settings, purpose, pilot, stop);
  if (pilot.is_interrupted) return std::nullopt;
  const RenderResult b = render_pilot(scene, of_second, purpose, pilot, stop);
  if (pilot.is_interrupted) return std::nullopt;
  pilot.is_dark = luminance(a.film.mean()) == 0 && luminance(b.film.mean()) == 0;
  const auto intervals_of = [&](const RenderResult& result) {
    return pixel_intervals(result.film, result.luminances, goal.confidence, settings.allocation_or_null());
  };
  const std::vector<PixelInterval> intervals_a = intervals_of(a), intervals_b = intervals_of(b);
  return distance({a.film, b.film, intervals_a, intervals_b});
}

/// What is known of each pixel, by the pilot that gave it most samples.
struct KnownPixels {
  explicit KnownPixels(std::size_t count)
      : samples(count), factors(count), differences_sq(count), log_ratios_sq(count, -1.0f) {}

  std::vector<bool> with_less_than(const std::vector<float>& other_samples) const {
    std::vector<bool> have_less(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) have_less[i] = samples[i] < other_samples[i];
    return have_less;
  }

  /// The power of the last two pilots, too, by the squared differences of the pixels that both know, each
  /// relative to what the first took for its squared factor.
  void take(const PixelDistances& distances, const std::vector<bool>& is_looked_at,
            const std::vector<float>& samples_now) {
    double before = 0, after = 0, growth = 0, count = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!is_looked_at[i]) continue;
      if (factors[i] > 0 && distances.factors[i] > 0) {
        const double square = std::pow(double(factors[i]), 2);
        before += double(differences_sq[i]) / square;
        after += double(distances.differences_sq[i]) / square;
        growth += std::log(double(samples_now[i] / samples[i]));
        ++count;
      }
      samples[i] = samples_now[i];
      factors[i] = distances.factors[i];
      differences_sq[i] = distances.differences_sq[i];
      log_ratios_sq[i] = distances.log_ratios_sq[i];
    }
    if (before > 0 && after > 0) power = expected_power(0.5 * std::log(after / before) * count / growth);
  }

  NeededSamples needed(int replicates) const {
    NeededSamples needed{std::vector<float>(samples.size()), spread_of(log_ratios_sq) / -power};
    for (std::size_t i = 0; i < samples.size(); ++i)
      needed.of_pixels[i] = samples[i] * std::pow(factors[i], float(-1 / power)) / float(replicates);
    return needed;
  }
  double most_samples() const { return *std::max_element(samples.begin(), samples.end()); }

  std::vector<float> samples, factors, differences_sq, log_ratios_sq;
  double power = power_of_independent;
};

std::vector<float> samples_of_pixels(const SampleAllocation& allocation, int replicates) {
  std::vector<float> samples;
  for (int y = 0; y < allocation.height(); ++y)
    for (int x = 0; x < allocation.width(); ++x) samples.push_back(float(replicates * allocation.at(x, y)));
  return samples;
}

/// Where pilots have met no light nobody knows what pixels need.
ErrorAllocation same_for_all(const Scene& scene, const RenderSettings& settings, const ErrorGoal& goal,
                             int most, const Pilot& before, const StopRequest* stop) {
  ErrorAllocation result;
  result.pilot = samples_for_error(scene, settings, goal, most, stop);
  result.pilot.samples += before.samples;
  result.pilot.seconds += before.seconds;
  if (result.pilot.is_interrupted) return result;
  result.replicates = default_replicates(result.pilot.samples_per_pixel);
  result.allocation = SampleAllocation(scene.camera.width_px, scene.camera.height_px,
                                       result.pilot.samples_per_pixel / result.replicates);
  return result;
}

}  // namespace

Pilot samples_for_error(const Scene& scene, const RenderSettings& settings, const ErrorGoal& goal, int most,
                        const StopRequest* stop) {
  Pilot pilot;
  double power = power_of_independent, factor_before = 0;
  for (int samples = least_pilot_samples, samples_before = 0;;) {
    const auto distance =
        distance_of_pilots(scene, with_samples(settings, samples), std::uint64_t(samples), goal, pilot, stop,
                           [&](const RenderedTwice& images) { return distance_from(images, goal); });
    if (!distance) return pilot;
    pilot.bars_over_errors = distance->bars_over_errors;
    if (pilot.is_dark && samples > least_pilot_samples) {
      pilot.samples_per_pixel = samples;
      return pilot;
    }
    if (std::isfinite(factor_before) && factor_before > 0 && distance->factor > 0)
      power = expected_power(std::log(distance->factor / factor_before) /
                             std::log(double(samples) / samples_before));
    const double needed = samples * std::pow(distance->factor, -1 / power);
    pilot.samples_per_pixel = rounded_up(needed, most);
    pilot.is_most = needed > pilot.samples_per_pixel;
    if (pilot.samples_per_pixel <= largest_growth * samples) return pilot;
    samples_before = samples;
    factor_before = distance->factor;
    samples = rounded_up(std::min(samples * largest_growth, pilot.samples_per_pixel / largest_growth), most);
  }
}

ErrorAllocation allocation_for_error(const Scene& scene, const RenderSettings& settings,
                                     const ErrorGoal& goal, int most, const StopRequest* stop) {
  constexpr std::uint64_t purpose = 0xa110ca7e;
  const int width = scene.camera.width_px, height = scene.camera.height_px;
  ErrorAllocation result;
  Pilot& pilot = result.pilot;
  RenderSettings of_pilot = with_samples(settings, least_pilot_samples);
  const int replicates_of_pilot = of_pilot.replicate_count();
  of_pilot.replicates = replicates_of_pilot;
  of_pilot.allocation = SampleAllocation(width, height, of_pilot.samples_per_replicate());
  KnownPixels known(std::size_t(width) * std::size_t(height));
  for (std::uint64_t round = 0;; ++round) {
    const std::vector<float> samples = samples_of_pixels(*of_pilot.allocation, replicates_of_pilot);
    const std::vector<bool> is_looked_at = known.with_less_than(samples);
    const auto distances = distance_of_pilots(
        scene, of_pilot, purpose + round, goal, pilot, stop,
        [&](const RenderedTwice& images) { return pixel_distances_from(images, goal, is_looked_at); });
    if (!distances) return result;
    if (pilot.is_dark) return same_for_all(scene, settings, goal, most, pilot, stop);
    known.take(*distances, is_looked_at, samples);
    pilot.bars_over_errors = distances->bars_over_errors;

    const auto allocate_for = [&](int replicates) {
      result.replicates = replicates;
      const auto most_of_replicate = std::bit_floor(
          std::uint64_t(std::max<std::int64_t>(most_samples_of_pixel(settings.integrator) / replicates, 1)));
      result.allocation = allocate_for_share(width, known.needed(replicates), goal.share,
                                             double(most) / replicates, int(most_of_replicate));
      return replicates * result.allocation->mean();
    };
    // The larger the mean, the more replicates may be.
    const double mean = std::max(allocate_for(replicates_of_pilot), double(least_pilot_samples));
    if (const int more = default_replicates(int(std::bit_floor(unsigned(mean)))); more > replicates_of_pilot)
      allocate_for(more);
    const NeededSamples needed = known.needed(result.replicates);
    pilot.samples_per_pixel = int(std::lround(result.replicates * result.allocation->mean()));
    pilot.is_most =
        expected_share(*result.allocation, needed) < goal.share - 0.5 / double(known.samples.size());
    if (double(result.replicates) * result.allocation->most() <= largest_growth * known.most_samples())
      return result;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int before = of_pilot.allocation->at(x, y);
        const double wanted =
            result.allocation->at(x, y) * double(result.replicates) / (largest_growth * replicates_of_pilot);
        of_pilot.allocation->at(x, y) = int(std::clamp(wanted, 1.0, largest_growth * before));
      }
  }
}

Pilot samples_for_time(const Scene& scene, const RenderSettings& settings, double seconds, int most,
                       const StopRequest* stop) {
  constexpr double share_of_pilot = 0.05, reserve = 0.97;
  Pilot pilot;
  for (int samples = least_pilot_samples;;) {
    const double before = pilot.seconds;
    render_pilot(scene, with_samples(settings, samples), std::uint64_t(samples), pilot, stop);
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
  const RenderResult result =
      render_with(scene, with_samples(settings, pilot.samples_per_pixel), purpose, stop);
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

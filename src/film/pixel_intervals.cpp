#include "film/pixel_intervals.h"

#include "stats/quantile.h"
#include "stats/running.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace etendue {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int reach = 2;  ///< Pixels to each side.
constexpr int most_pooled = (2 * reach + 1) * (2 * reach + 1);

/// Standard error of the mean luminance.
double luminance_error(const PixelStatistics& pixel, std::span<const float> replicates) {
  if (replicates.empty()) return luminance(standard_error(pixel));
  return statistics_of(replicates).standard_error();
}

/// What neighbours look at, one row below the other with a margin, where nothing is alike.
struct Planes {
  Planes(const Film& film, const ReplicateLuminances& luminances, const SampleAllocation* allocation)
      : stride(film.width() + 2 * reach),
        mean(std::size_t(stride) * std::size_t(film.height() + 2 * reach), nan),
        error(mean.size(), 0.0f),
        spread(mean.size(), 0.0f),
        samples_per_replicate(mean.size(), 1.0f) {
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) {
        const PixelStatistics& pixel = film.at(x, y);
        if (pixel.count < 2) continue;
        const std::size_t i = at(x, y);
        mean[i] = float(luminance(pixel.mean));
        error[i] = float(luminance_error(pixel, luminances.at(x, y, pixel.count)));
        if (allocation) samples_per_replicate[i] = float(allocation->at(x, y));
        spread[i] = error[i] * std::sqrt(samples_per_replicate[i]);
        replicates = std::max(replicates, pixel.count);
        const Color<double> most{pixel.mean.r + std::sqrt(pixel.m2.r), pixel.mean.g + std::sqrt(pixel.m2.g),
                                 pixel.mean.b + std::sqrt(pixel.m2.b)};
        largest = std::max(largest, samples_per_replicate[i] * float(std::max({most.r, most.g, most.b})));
      }
  }
  std::size_t at(int x, int y) const {
    return std::size_t(y + reach) * std::size_t(stride) + std::size_t(x + reach);
  }

  int stride;
  std::vector<float> mean, error;  ///< Of luminance; not a number where there is no error.
  std::vector<float> spread;  ///< The error if a replicate were one sample, as errors fall with the root.
  std::vector<float> samples_per_replicate;
  std::int64_t replicates = 2;
  float largest = 0;  ///< No channel of a replicate, times its samples, is above it.
};

/// Of two pixels' means of luminance and the errors of these.
bool are_alike(float mean_a, float error_a, float mean_b, float error_b) {
  constexpr float within = 3;  // Standard errors of the noisier one.
  return std::abs(mean_a - mean_b) <= within * (error_a > error_b ? error_a : error_b);
}

/// The sum of squared spreads of luminance over the alike pixels around those of a row, themselves included.
struct Pool {
  explicit Pool(int width) : count(std::size_t(width)), spread_sq(count.size()) {}
  void add(const Planes& planes, int y, int dx, int dy) {
    const std::size_t here = planes.at(0, y), there = planes.at(dx, y + dy);
    const float *mean = &planes.mean[here], *error = &planes.error[here];
    const float *other_mean = &planes.mean[there], *other_error = &planes.error[there],
                *other_spread = &planes.spread[there];
    float *to_count = count.data(), *to_spread_sq = spread_sq.data();
    for (std::size_t x = 0; x < count.size(); ++x) {
      const float is_alike = are_alike(mean[x], error[x], other_mean[x], other_error[x]) ? 1.0f : 0.0f;
      to_count[x] += is_alike;
      to_spread_sq[x] += is_alike * other_spread[x] * other_spread[x];
    }
  }
  /// Of a pixel of the row that takes so many samples a replicate.
  float error(std::size_t x, float samples_per_replicate) const {
    return std::sqrt(spread_sq[x] / (count[x] * samples_per_replicate));
  }
  std::vector<float> count, spread_sq;
};

/// The error of each channel by the alike pixels within `side` of one: the root of their mean squared spread.
Color<double> pooled_error(const Planes& planes, const Film& film, int x, int y, int side) {
  Color<double> sum{0, 0, 0};
  double count = 0;
  const std::size_t here = planes.at(x, y);
  for (int dy = -side; dy <= side; ++dy)
    for (int dx = -side; dx <= side; ++dx) {
      const std::size_t there = planes.at(x + dx, y + dy);
      if (!are_alike(planes.mean[here], planes.error[here], planes.mean[there], planes.error[there]))
        continue;
      const PixelStatistics& pixel = film.at(x + dx, y + dy);
      const double more_samples =
          double(planes.samples_per_replicate[there]) / double(planes.samples_per_replicate[here]);
      sum = sum + pixel.m2 * (more_samples / (double(pixel.count) * double(pixel.count - 1)));
      ++count;
    }
  return {std::sqrt(sum.r / count), std::sqrt(sum.g / count), std::sqrt(sum.b / count)};
}

}  // namespace

std::vector<PixelInterval> pixel_intervals(const Film& film, const ReplicateLuminances& luminances,
                                           double confidence, const SampleAllocation* allocation) {
  if (!(confidence > 0 && confidence < 1))
    throw std::domain_error("pixel_intervals: the confidence must lie in (0, 1)");
  constexpr float own_holds_from = 0.75f, near_holds_from = 0.5f;
  const Planes planes(film, luminances, allocation);
  std::array<float, most_pooled + 1> quantiles{};  // By the number of pixels in the pool.
  for (int pixels = 1; pixels <= most_pooled; ++pixels)
    quantiles[std::size_t(pixels)] =
        float(student_t_quantile((1 + confidence) / 2, double(pixels * (planes.replicates - 1))));
  std::vector<PixelInterval> intervals(std::size_t(film.width()) * std::size_t(film.height()));
  for (int y = 0; y < film.height(); ++y) {
    Pool near(film.width());
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) near.add(planes, y, dx, dy);
    Pool wide = near;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if (std::max(std::abs(dx), std::abs(dy)) > 1) wide.add(planes, y, dx, dy);
    for (std::size_t x = 0; x < std::size_t(film.width()); ++x) {
      const std::size_t at = planes.at(int(x), y);
      PixelInterval& interval = intervals[std::size_t(y) * std::size_t(film.width()) + x];
      if (std::isnan(planes.mean[at])) {
        interval = {{nan, nan, nan}, nan, nan, IntervalRule::unknown};
        continue;
      }
      const float samples = planes.samples_per_replicate[at];
      const float own = planes.error[at], near_error = near.error(x, samples),
                  wide_error = wide.error(x, samples);
      interval.luminance_error = own;
      if (planes.mean[at] == 0 && wide_error == 0) {
        const float most = float(-std::log(1 - confidence)) * planes.largest /
                           (samples * float(planes.replicates) * wide.count[x]);
        interval = {{most, most, most}, most, own, IntervalRule::black};
        continue;
      }
      interval.rule = near_error < near_holds_from * wide_error ? IntervalRule::rare_events
                      : own < own_holds_from * near_error       ? IntervalRule::neighbours
                                                                : IntervalRule::student_t;
      const Color<double> error = standard_error(film.at(int(x), y));
      const Color<float> of_own = quantiles[1] * Color<float>{float(error.r), float(error.g), float(error.b)};
      interval.half_width = of_own;
      interval.luminance_half_width = quantiles[1] * own;
      if (interval.rule == IntervalRule::student_t) continue;
      const bool is_near = interval.rule == IntervalRule::neighbours;
      const Pool& pool = is_near ? near : wide;
      const float quantile = quantiles[std::size_t(pool.count[x])];
      const Color<double> pooled = pooled_error(planes, film, int(x), y, is_near ? 1 : reach);
      interval.half_width = {std::max(of_own.r, quantile * float(pooled.r)),
                             std::max(of_own.g, quantile * float(pooled.g)),
                             std::max(of_own.b, quantile * float(pooled.b))};
      interval.luminance_half_width =
          std::max(interval.luminance_half_width, quantile * pool.error(x, samples));
    }
  }
  return intervals;
}

}  // namespace etendue

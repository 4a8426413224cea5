#include "film/error_goal.h"

#include "stats/quantile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace etendue {
namespace {

/// What a pixel may be off, of luminance, before the goal's `relative`.
double scale_of(double pixel, double mean_of_image) { return std::max(pixel, 0.01 * mean_of_image); }

/// The standard error of a black pixel is that of the alike ones around it.
double standard_error_of(const PixelInterval& interval, double pixel, double quantile) {
  if (pixel > 0 || interval.rule == IntervalRule::black) return interval.luminance_error;
  return interval.luminance_half_width / quantile;
}

struct PixelErrors {
  double variance;            ///< As its replicates say, over the squared scale of the pixel.
  double squared_difference;  ///< Half of it, over the same.
};

/// So many pixels that are as their bars say stand beside those that are looked at, which may be few.
constexpr double pixels_as_told = 16;
constexpr std::ptrdiff_t window_over_beyond = 4;

}  // namespace

double share_within(const Film& film, std::span<const PixelInterval> intervals, const ErrorGoal& goal) {
  const double mean = luminance(film.mean());
  std::int64_t rendered = 0, within = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const PixelInterval& interval = intervals[std::size_t(y) * std::size_t(film.width()) + std::size_t(x)];
      if (interval.rule == IntervalRule::unknown) continue;
      ++rendered;
      if (mean > 0)
        within +=
            interval.rule == IntervalRule::black ||
            interval.luminance_half_width <= goal.relative * scale_of(luminance(film.at(x, y).mean), mean);
    }
  return rendered > 0 ? double(within) / double(rendered) : 0;
}

DistanceFromGoal distance_from(const RenderedTwice& images, const ErrorGoal& goal) {
  const double mean = 0.5 * (luminance(images.a.mean()) + luminance(images.b.mean()));
  if (!(mean > 0)) return {std::numeric_limits<double>::infinity(), 1};
  const double quantile = normal_quantile((1 + goal.confidence) / 2);
  std::vector<PixelErrors> pixels;
  for (int y = 0; y < images.a.height(); ++y)
    for (int x = 0; x < images.a.width(); ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(images.a.width()) + std::size_t(x);
      const PixelInterval &of_a = images.intervals_a[i], &of_b = images.intervals_b[i];
      if (of_a.rule == IntervalRule::unknown || of_b.rule == IntervalRule::unknown) continue;
      const double a = luminance(images.a.at(x, y).mean), b = luminance(images.b.at(x, y).mean);
      const double scale_sq = std::pow(scale_of((a + b) / 2, mean), 2);
      const double variance = (std::pow(standard_error_of(of_a, a, quantile), 2) +
                               std::pow(standard_error_of(of_b, b, quantile), 2)) /
                              2;
      pixels.push_back({variance / scale_sq, (a - b) * (a - b) / 2 / scale_sq});
    }
  if (pixels.empty()) return {std::numeric_limits<double>::infinity(), 1};
  std::sort(pixels.begin(), pixels.end(),
            [](const PixelErrors& a, const PixelErrors& b) { return a.variance > b.variance; });
  const auto count = std::ptrdiff_t(pixels.size());
  const auto beyond =
      std::clamp<std::ptrdiff_t>(std::ptrdiff_t((1 - goal.share) * double(count)), 0, count - 1);
  const double told = pixels[std::size_t(beyond)].variance;
  const std::ptrdiff_t first = beyond / window_over_beyond,
                       last = std::min(count, window_over_beyond * (beyond + 1));
  double differences = 0, variances = 0;
  for (std::ptrdiff_t i = first; i < last; ++i) {
    differences += pixels[std::size_t(i)].squared_difference;
    variances += pixels[std::size_t(i)].variance;
  }
  if (!(variances > 0)) return {0, 1};
  const double as_told = pixels_as_told / double(last - first);
  const double errors_over_bars = std::sqrt((differences / variances + as_told) / (1 + as_told));
  return {quantile * std::sqrt(told) * errors_over_bars / goal.relative, 1 / errors_over_bars};
}

}  // namespace etendue

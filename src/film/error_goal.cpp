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
constexpr float worth_counting = 0.25f;  ///< A smaller factor will hardly decide anything.
constexpr std::size_t least_reach = 64;  ///< Of pixels alike in their half-widths, to each side.

double quantile_of(const ErrorGoal& goal) { return normal_quantile((1 + goal.confidence) / 2); }

/// 0 where neither the pixel nor an alike one near it has met light, as such pixels count as within.
double half_width_of(const PixelInterval& interval) {
  return interval.rule == IntervalRule::black ? 0 : double(interval.luminance_half_width);
}

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
  const double quantile = quantile_of(goal);
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

double spread_of(const std::vector<float>& log_ratios_sq) {
  double sum = 0;
  std::int64_t count = 0;
  for (const float ratio_sq : log_ratios_sq)
    if (ratio_sq >= 0) sum += double(ratio_sq), ++count;
  // The mean of two has half the deviation of their difference.
  return count > 0 ? 0.5 * std::sqrt(sum / double(count)) : 0;
}

PixelDistances pixel_distances_from(const RenderedTwice& images, const ErrorGoal& goal,
                                    const std::vector<bool>& is_looked_at) {
  const std::size_t width = std::size_t(images.a.width()), count = width * std::size_t(images.a.height());
  PixelDistances distances{std::vector<float>(count), std::vector<float>(count),
                           std::vector<float>(count, -1.0f)};
  const double mean = 0.5 * (luminance(images.a.mean()) + luminance(images.b.mean()));
  const double quantile = quantile_of(goal);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < count; ++i) {
    const PixelInterval &of_a = images.intervals_a[i], &of_b = images.intervals_b[i];
    if (!is_looked_at[i] || of_a.rule == IntervalRule::unknown || of_b.rule == IntervalRule::unknown)
      continue;
    const double a = luminance(images.a.at(int(i % width), int(i / width)).mean),
                 b = luminance(images.b.at(int(i % width), int(i / width)).mean);
    const double allowed = goal.relative * scale_of((a + b) / 2, mean);
    const double width_a = half_width_of(of_a) / allowed, width_b = half_width_of(of_b) / allowed;
    if (!(width_a > 0 || width_b > 0)) continue;
    distances.factors[i] = float(std::sqrt((width_a * width_a + width_b * width_b) / 2));
    distances.differences_sq[i] = float(std::pow(quantile * (a - b) / allowed, 2) / 2);
    if (distances.factors[i] > worth_counting && width_a > 0 && width_b > 0)
      distances.log_ratios_sq[i] = float(std::pow(std::log(width_a / width_b), 2));
    order.push_back(i);
  }
  if (order.empty()) return distances;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return distances.factors[a] > distances.factors[b]; });
  // Of what squared differences are to squared half-widths, squared again, so that of pixels that differ in
  // this those count that are worse; of normal errors as told it is 3 on average.
  constexpr double of_normal = 3;
  std::vector<double> sums{0};  // Over all before.
  for (const std::size_t i : order)
    sums.push_back(sums.back() + std::pow(double(distances.differences_sq[i]), 2) /
                                     std::pow(double(distances.factors[i]), 4));
  double sum_of_ratios = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t reach = least_reach + rank / 4;
    const std::size_t first = rank - std::min(rank, reach), last = std::min(rank + reach + 1, order.size());
    const double number = double(last - first);
    const double ratio = (std::sqrt((sums[last] - sums[first]) * number / of_normal) + pixels_as_told) /
                         (number + pixels_as_told);
    sum_of_ratios += ratio;
    distances.factors[order[rank]] *= float(std::sqrt(ratio));
  }
  distances.bars_over_errors = std::sqrt(double(order.size()) / sum_of_ratios);
  return distances;
}

}  // namespace etendue

#include "film/convergence.h"

#include "stats/quantile.h"
#include "stats/running.h"
#include "stats/t_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace etendue {
namespace {

constexpr double unknown_check = std::numeric_limits<double>::quiet_NaN();

/// Sums over pixels of the squared differences between neighbouring groups of 1, 2, 4 ... replicates. Their
/// ratio says how the error of a mean falls, also where replicates are not independent.
class GroupDifferences {
 public:
  explicit GroupDifferences(std::size_t replicates)
      : levels_(replicates < 2 ? 0 : std::size_t(std::log2(double(replicates)))), sums_(levels_) {}

  void add(std::span<const float> replicates) {
    group_.assign(replicates.begin(), replicates.end());
    for (std::size_t level = 0; level < levels_; ++level) {
      const std::size_t pairs = group_.size() / 2;
      double sum = 0;
      for (std::size_t k = 0; k < pairs; ++k) {
        const float a = group_[2 * k], b = group_[2 * k + 1];
        sum += double(a - b) * double(a - b);
        group_[k] = 0.5f * (a + b);
      }
      group_.resize(pairs);
      sums_[level] += sum / double(pairs);
    }
  }

  /// Of log error over log replicates, by least squares; NaN where there are not two levels.
  double slope() const {
    double count = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t level = 0; level < levels_; ++level) {
      if (!(sums_[level] > 0)) return unknown_check;
      const double at = double(level), value = 0.5 * std::log2(sums_[level]);
      count += 1;
      x += at;
      y += value;
      xx += at * at;
      xy += at * value;
    }
    return count < 2 ? unknown_check : (xy - x * y / count) / (xx - x * x / count);
  }

 private:
  std::size_t levels_;
  std::vector<double> sums_;
  std::vector<float> group_;
};

/// Which tenth the p-value of the t-test between two halves of a pixel lies in, without computing it.
class HalvesTest {
 public:
  explicit HalvesTest(std::int64_t in_half) : in_half_(in_half) {
    const double degrees_of_freedom = 2.0 * double(in_half - 1);
    for (std::size_t k = 0; k < bounds_.size(); ++k)
      bounds_[k] = student_t_quantile(1 - 0.05 * double(k + 1), degrees_of_freedom);
    one_percent_ = student_t_quantile(0.995, degrees_of_freedom);
  }
  void add(std::span<const float> replicates, ConvergenceChecks& checks) const {
    const auto half = std::size_t(in_half_);
    const RunningStatistics a = statistics_of(replicates.first(half)),
                            b = statistics_of(replicates.last(half));
    const double variance = (a.m2 + b.m2) / (2.0 * double(in_half_ - 1));
    if (!(variance > 0)) return;
    const double t = std::abs(a.mean - b.mean) / std::sqrt(2 * variance / double(in_half_));
    const auto tenth =
        std::size_t(std::count_if(bounds_.begin(), bounds_.end(), [&](double bound) { return t < bound; }));
    ++checks.p_values[tenth];
    checks.p_values_below_1_percent += t > one_percent_;
  }

 private:
  std::int64_t in_half_;
  std::array<double, 9> bounds_{};  ///< |t| at p = 0.1, 0.2 ... 0.9.
  double one_percent_;
};

}  // namespace

std::int64_t ConvergenceChecks::pixels_tested() const {
  return std::accumulate(p_values.begin(), p_values.end(), std::int64_t{0});
}

ConvergenceChecks convergence_checks(const Film& film, const ReplicateLuminances& luminances,
                                     const PixelRectangle& region) {
  ConvergenceChecks checks{unknown_check, unknown_check, unknown_check, unknown_check};
  const std::int64_t replicates = film.at(region.x_begin, region.y_begin).count;
  if (!luminances.is_kept() || replicates < 2) return checks;
  constexpr int batches_across = 4;  // Of interleaved pixels: their slopes tell how well the slope is known.
  std::vector<GroupDifferences> batches(batches_across * batches_across,
                                        GroupDifferences(std::size_t(replicates)));
  GroupDifferences all{std::size_t(replicates)};
  const HalvesTest halves(std::max<std::int64_t>(replicates / 2, 2));
  double sum = 0, largest_rise = 0;
  for (int y = region.y_begin; y < region.y_end; ++y)
    for (int x = region.x_begin; x < region.x_end; ++x) {
      if (film.at(x, y).count != replicates) continue;
      const std::span<const float> values = luminances.at(x, y, replicates);
      const double mean = luminance(film.at(x, y).mean);
      sum += mean;
      const double largest = *std::max_element(values.begin(), values.end());
      largest_rise = std::max(largest_rise, (largest - mean) / double(replicates + 1));
      all.add(values);
      batches[std::size_t(y % batches_across * batches_across + x % batches_across)].add(values);
      if (replicates >= 4) halves.add(values, checks);
    }
  if (sum > 0) checks.rise_by_largest = largest_rise / sum;
  RunningStatistics slopes;
  for (const GroupDifferences& batch : batches)
    if (const double slope = batch.slope(); !std::isnan(slope)) slopes.add(slope);
  checks.slope = all.slope();
  if (slopes.count >= 2) {
    const Interval around = student_t_interval(slopes, 0.95);
    const double half_width = 0.5 * (around.upper - around.lower);
    checks.slope_low = checks.slope - half_width;
    checks.slope_high = checks.slope + half_width;
  }
  return checks;
}

}  // namespace etendue

#include "stats/pareto_tail.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace etendue {
namespace {

/// k of the distribution whose density falls as x^-(1 + 1/k), or ends where k < 0.
/// \param x ascending, above 0
double shape_of(std::span<const double> x) {
  const auto shape_at = [&](double theta) {
    double sum = 0;
    for (const double value : x) sum += std::log1p(-theta * value);
    return sum / double(x.size());
  };
  constexpr double prior = 3;
  const double n = double(x.size()), quartile = x[std::size_t(n / 4 + 0.5) - 1];
  const int points = 30 + int(std::sqrt(n));
  std::vector<double> thetas, log_likelihoods;
  for (int j = 1; j <= points; ++j) {
    const double theta = 1 / x.back() + (1 - std::sqrt(points / (j - 0.5))) / (prior * quartile);
    const double shape = shape_at(theta);
    thetas.push_back(theta);
    log_likelihoods.push_back(n * (std::log(-theta / shape) - shape - 1));
  }
  const double most = *std::max_element(log_likelihoods.begin(), log_likelihoods.end());
  double weights = 0, weighted = 0;
  for (std::size_t j = 0; j < thetas.size(); ++j) {
    const double weight = std::exp(log_likelihoods[j] - most);
    weights += weight;
    weighted += weight * thetas[j];
  }
  return shape_at(weighted / weights);
}

double slope_of(double shape) {
  return shape > 1 / (ParetoTail::steepest - 1) ? 1 + 1 / shape : ParetoTail::steepest;
}

}  // namespace

ParetoTail pareto_tail(const LargestValues& largest) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t least = 50;
  constexpr std::int64_t one_in = 20;  // Nearer values are no tail.
  std::vector<double> values(largest.values().begin(), largest.values().end());
  std::sort(values.begin(), values.end(), std::greater<>());
  values.resize(std::min(values.size(), std::size_t(largest.count() / one_in)));
  if (values.size() <= least) return {unknown, unknown, unknown};
  const double threshold = values.back();
  std::reverse(values.begin(), values.end());
  std::vector<double> excesses;
  for (const double value : values)
    if (value > threshold) excesses.push_back(value - threshold);
  if (excesses.size() < least) return {ParetoTail::steepest, ParetoTail::steepest, ParetoTail::steepest};
  const double shape = shape_of(excesses);
  const double half_width = 1.96 * (1 + std::max(shape, 0.0)) / std::sqrt(double(excesses.size()));
  return {slope_of(shape), slope_of(shape + half_width), slope_of(shape - half_width)};
}

}  // namespace etendue

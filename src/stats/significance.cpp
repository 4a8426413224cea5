#include "stats/significance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace etendue {

double sidak_level(double level, std::int64_t tests) {
  if (!(level > 0 && level < 1)) throw std::domain_error("sidak_level: the level must lie in (0, 1)");
  if (tests < 1) throw std::domain_error("sidak_level: there must be at least one test");
  return -std::expm1(std::log1p(-level) / double(tests));
}

bool is_rejected(double p_value, double level, std::int64_t tests) {
  return !(p_value >= sidak_level(level, tests));
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    if (!std::isnan(p_values[i])) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.begin(), p_values.end());
  double least = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    least = std::max(least, std::min(1.0, p_values[order[rank]] * double(order.size() - rank)));
    adjusted[order[rank]] = least;
  }
  return adjusted;
}

}  // namespace etendue

#include "light/inversion_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace etendue {

void append_cumulative_shares(std::span<const double> weights, std::vector<std::int32_t>& shares) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0;
  shares.push_back(0);
  for (const double weight : weights) {
    sum += weight;
    shares.push_back(total > 0 ? std::int32_t(std::round(sum / total * inversion_whole)) : 0);
  }
}

void append_positive_shares(std::vector<double> weights, std::vector<std::int32_t>& shares,
                            double least_share) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights)
    weight = !(total > 0) ? 1 : weight > 0 ? std::max(weight, total * least_share) : 0;
  append_cumulative_shares(weights, shares);
}

}  // namespace etendue

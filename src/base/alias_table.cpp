#include "base/alias_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace etendue {
namespace {

/// The weights over their mean. Scaled by the largest first, so that their sum cannot overflow.
std::vector<double> relative_to_mean(std::span<const double> weights) {
  if (weights.empty()) throw std::invalid_argument("alias table: no weights");
  if (weights.size() > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("alias table: too many weights");
  double largest = 0;
  for (const double w : weights) {
    if (!(w >= 0) || !std::isfinite(w))
      throw std::invalid_argument("alias table: weights must be finite and not negative");
    largest = std::max(largest, w);
  }
  if (largest == 0) throw std::invalid_argument("alias table: all weights are zero");
  double sum = 0;
  for (const double w : weights) sum += w / largest;
  std::vector<double> relative;
  relative.reserve(weights.size());
  for (const double w : weights) relative.push_back(w / largest / sum * static_cast<double>(weights.size()));
  return relative;
}

/// A cell that is all its own has the highest threshold, and itself for the one fraction left over.
std::uint32_t fixed_point(double probability) {
  constexpr double highest = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::min(std::round(probability * 0x1p32), highest));
}

std::uint64_t divide_up(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

/// Counts, for each entry, the values of u that choose it.
std::vector<float> count_choices(const std::vector<std::uint32_t>& threshold,
                                 const std::vector<std::int32_t>& alias) {
  const std::uint64_t n = threshold.size();
  std::vector<std::uint64_t> choices(n);
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto first = divide_up(i << 32, n);
    const auto split = divide_up((i << 32) + threshold[i], n);
    const auto last = divide_up((i + 1) << 32, n);
    choices[i] += split - first;
    choices[std::size_t(alias[i])] += last - split;
  }
  std::vector<float> pmf;
  pmf.reserve(n);
  for (const auto count : choices) pmf.push_back(static_cast<float>(static_cast<double>(count) * 0x1p-32));
  return pmf;
}

}  // namespace

AliasTable make_alias_table(std::span<const double> weights) {
  auto remaining = relative_to_mean(weights);
  const auto heaviest =
      static_cast<std::uint32_t>(std::max_element(remaining.begin(), remaining.end()) - remaining.begin());
  std::vector<std::uint32_t> small, large;
  for (std::uint32_t i = 0; i < remaining.size(); ++i) (remaining[i] < 1 ? small : large).push_back(i);

  AliasTable table;
  table.threshold.resize(remaining.size());
  table.alias.resize(remaining.size());
  while (!small.empty() && !large.empty()) {
    const auto light = small.back();
    const auto heavy = large.back();
    small.pop_back();
    table.threshold[light] = fixed_point(remaining[light]);
    table.alias[light] = static_cast<std::int32_t>(heavy);
    remaining[heavy] = (remaining[heavy] + remaining[light]) - 1;
    if (remaining[heavy] < 1) {
      large.pop_back();
      small.push_back(heavy);
    }
  }
  for (const auto i : large) {
    table.threshold[i] = fixed_point(1);
    table.alias[i] = static_cast<std::int32_t>(i);
  }
  // Rounding can use up the large ones too early. What is left is nearly full, or of weight zero: never
  // itself.
  for (const auto i : small) {
    table.threshold[i] = fixed_point(remaining[i]);
    table.alias[i] = static_cast<std::int32_t>(heaviest);
  }
  table.pmf = count_choices(table.threshold, table.alias);
  return table;
}

}  // namespace etendue

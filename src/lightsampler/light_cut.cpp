#include "lightsampler/light_cut.h"

#include "light/inversion_table.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// The roundest binary number that is near enough.
double round_number_near(double x, double tolerance) {
  constexpr double least_unit = 0x1p-12;
  for (double unit = 0.5; unit >= least_unit; unit /= 2) {
    const double near = std::round(x / unit) * unit;
    if (std::abs(near - x) <= tolerance) return near;
  }
  return x;
}

/// Moves the ends of shares, whose sum is 1, to round numbers: of 64 points of a pixel as many lie between
/// two multiples of 1/64 as of any other 64, so how often a cluster is chosen adds no noise. No share loses
/// more than half.
void round_ends(std::span<double> shares) {
  double end = 0, rounded = 0;
  for (std::size_t k = 0; k + 1 < shares.size(); ++k) {
    end += shares[k];
    const double to = round_number_near(end, std::min(shares[k], shares[k + 1]) / 4);
    shares[k] = to - rounded;
    rounded = to;
  }
  if (!shares.empty()) shares.back() = 1 - rounded;
}

}  // namespace

LightCut light_cut_of(std::span<const CutCluster> clusters, std::int32_t facets) {
  LightCut cut;
  cut.places.fill(facets);
  std::vector<double> weights(LightCut::most_clusters);
  std::size_t position = 0;
  double whole = 0;
  for (const CutCluster& cluster : clusters) whole += cluster.weight;
  constexpr double seen_from = 0.5;
  const auto take = [&](std::size_t cluster) {
    cut.clusters[position] = std::int32_t(cluster);
    cut.positions[cluster] = std::int32_t(position++);
  };
  for (const bool is_seen : {true, false})
    for (std::size_t c = 0; c < clusters.size(); ++c)
      if ((clusters[c].visibility >= seen_from) == is_seen) {
        cut.places[c] = clusters[c].begin;
        weights[position] = whole > 0 ? clusters[c].weight / whole : 0;
        take(c);
      }
  while (position < LightCut::most_clusters) take(position);
  if (whole > 0) round_ends(std::span(weights).first(clusters.size()));
  std::vector<std::int32_t> shares;
  append_cumulative_shares(weights, shares);
  std::copy(shares.begin(), shares.end(), cut.shares.begin());
  for (std::int32_t g = 0, at = 0; g < LightCut::guides; ++g) {
    while (at + 1 < LightCut::most_clusters &&
           cut.shares[std::size_t(at + 1)] <= g * (inversion_whole / LightCut::guides))
      ++at;
    cut.guide[std::size_t(g)] = at;
  }
  return cut;
}

}  // namespace etendue

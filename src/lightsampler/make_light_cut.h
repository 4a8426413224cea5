// How a cut of the light tree is made for what the pilot rays of a tile have met.
#pragma once

#include "light/inversion_table.h"
#include "lightsampler/light_cut.h"
#include "lightsampler/light_importance.h"
#include "lightsampler/light_tree.h"

#include <algorithm>
#include <array>
#include <vector>

namespace etendue {

inline constexpr int light_cut_pilots = 16;  ///< Places of a tile that a cut is made for.

/// Splits the cluster where most may be gained, again and again; a cluster's share is the mean of what it is
/// to the pilots, and a tenth by its power alone. \param receivers of the pilots, in packets \param is_lit
/// which of them count \param scattered(p, importance) how much the packet p of them scatters of a cluster's
/// light, relative to that of others
template <class F, class Scattered>
LightCut make_light_cut(const LightTree& tree, const Receiver<F>* receivers, const Mask<F>* is_lit,
                        const Scattered& scattered) {
  // How much each pilot gets of a cluster, all of them alike: relative to the whole tree.
  constexpr int packets = light_cut_pilots / lane_count_v<F>;
  const LightCluster* clusters = tree.clusters();
  std::array<F, packets> scale;
  bool is_any_lit = false;
  for (int p = 0; p < packets; ++p) {
    const F whole_tree = importance(broadcast<F>(clusters[0]), receivers[p]).value;
    const Mask<F> counts = mask_and(is_lit[p], whole_tree > F(0));
    is_any_lit = is_any_lit || any(counts);
    scale[std::size_t(p)] = select(counts, F(1) / select(counts, whole_tree, F(1)), F(0));
  }
  struct alignas(64) Shares {
    std::array<float, light_cut_pilots> of_pilot;
  };
  struct Open {
    float urgency;  ///< What may be gained by splitting it.
    std::int32_t cluster, shares;
  };
  static thread_local std::vector<Shares> shares_of(2 * LightCut::most_clusters);
  std::int32_t opened = 0;
  const auto open = [&](std::int32_t cluster) {
    const ClusterLanes<F> in_lanes = broadcast<F>(clusters[cluster]);
    float* shares = shares_of[std::size_t(opened)].of_pilot.data();
    alignas(64) std::array<float, light_cut_pilots> spreads;
    for (int p = 0; p < packets; ++p) {
      const Importance<F> of = importance(in_lanes, receivers[p]);
      const F share = of.value * scale[std::size_t(p)] * scattered(p, of);
      store_lanes(shares + p * lane_count_v<F>, share);
      store_lanes(&spreads[std::size_t(p * lane_count_v<F>)], share * of.spread_sq);
    }
    float share = 0, spread = 0;
    for (int k = 0; k < light_cut_pilots; ++k) {
      share += shares[k];
      spread += spreads[std::size_t(k)];
    }
    const bool is_leaf = clusters[cluster].first_child == 0;
    const float urgency = spread + share * (0.02f + 0.25f * (1 - clusters[cluster].cos_normals));
    return Open{is_leaf ? 0 : urgency, cluster, opened++};
  };
  const auto is_less_urgent = [](const Open& x, const Open& y) { return x.urgency < y.urgency; };
  std::vector<Open> heap{open(0)};
  while (heap.size() < LightCut::most_clusters && is_any_lit && heap.front().urgency > 0) {
    const std::int32_t first_child = clusters[heap.front().cluster].first_child;
    std::pop_heap(heap.begin(), heap.end(), is_less_urgent);
    heap.back() = open(first_child);
    std::push_heap(heap.begin(), heap.end(), is_less_urgent);
    heap.push_back(open(first_child + 1));
    std::push_heap(heap.begin(), heap.end(), is_less_urgent);
  }
  std::sort(heap.begin(), heap.end(), [&](const Open& x, const Open& y) {
    return clusters[x.cluster].begin < clusters[y.cluster].begin;
  });
  const auto share_of = [&](const Open& entry, std::size_t k) {
    return double(shares_of[std::size_t(entry.shares)].of_pilot[k]);
  };
  std::array<double, light_cut_pilots> whole{};
  for (const Open& entry : heap)
    for (std::size_t k = 0; k < light_cut_pilots; ++k) whole[k] += share_of(entry, k);
  int lit = 0;
  for (const double w : whole) lit += w > 0;
  // What no pilot has met may be lit by anything.
  const double defence = lit > 0 ? 0.1 : 1;
  // Shares are whole numbers: one that rounds to 0 would leave its lights out.
  constexpr double least_share = 0x1p-28;
  std::vector<double> weights(LightCut::most_clusters);
  LightCut cut;
  cut.places.fill(tree.facet_count());
  for (std::size_t e = 0; e < heap.size(); ++e) {
    const LightCluster& cluster = clusters[heap[e].cluster];
    cut.places[e] = cluster.begin;
    double seen = 0;
    for (std::size_t k = 0; k < light_cut_pilots; ++k)
      if (whole[k] > 0) seen += share_of(heap[e], k) / whole[k];
    const double weight = defence * double(cluster.power) / double(clusters[0].power) +
                          (lit > 0 ? (1 - defence) * seen / lit : 0);
    weights[e] = cluster.power > 0 ? std::max(least_share, weight) : 0;
  }
  std::vector<std::int32_t> shares;
  append_cumulative_shares(weights, shares);
  std::copy(shares.begin(), shares.end(), cut.shares.begin());
  for (std::int32_t g = 0, e = 0; g < LightCut::guides; ++g) {
    while (e + 1 < LightCut::most_clusters &&
           cut.shares[std::size_t(e + 1)] <= g * (inversion_whole / LightCut::guides))
      ++e;
    cut.guide[std::size_t(g)] = e;
  }
  return cut;
}

}  // namespace etendue

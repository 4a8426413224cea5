// How a cut of the light tree is made for what the pilot rays of a tile have met.
#pragma once

#include "lightsampler/cluster_visibility.h"
#include "lightsampler/light_cut.h"
#include "lightsampler/light_importance.h"
#include "lightsampler/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace etendue {

/// Splits the cluster where most may be gained, again and again; a cluster's share is the mean of what it is
/// to the pilots, less where they hardly see it, and a tenth by its power alone. \param receivers of the
/// pilots, in packets \param is_lit which of them count \param scattered(p, importance) how much the packet p
/// of them scatters of a cluster's light, relative to that of others \param see as visibility_of asks for
template <class F, class Scattered, class See>
LightCut make_light_cut(const LightTree& tree, const Receiver<F>* receivers, const Mask<F>* is_lit,
                        const Scattered& scattered, const See& see) {
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
    std::int32_t cluster, node;
  };
  static thread_local std::vector<Shares> shares_of(2 * LightCut::most_clusters);
  std::vector<CutNode> nodes;
  const auto open = [&](std::int32_t cluster, std::int32_t parent) {
    const ClusterLanes<F> in_lanes = broadcast<F>(clusters[cluster]);
    float* shares = shares_of[nodes.size()].of_pilot.data();
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
    nodes.push_back({cluster, parent});
    return Open{is_leaf ? 0 : urgency, cluster, std::int32_t(nodes.size()) - 1};
  };
  const auto is_less_urgent = [](const Open& x, const Open& y) { return x.urgency < y.urgency; };
  std::vector<Open> heap{open(0, 0)};
  while (heap.size() < LightCut::most_clusters && is_any_lit && heap.front().urgency > 0) {
    const std::int32_t first_child = clusters[heap.front().cluster].first_child, parent = heap.front().node;
    std::pop_heap(heap.begin(), heap.end(), is_less_urgent);
    heap.back() = open(first_child, parent);
    std::push_heap(heap.begin(), heap.end(), is_less_urgent);
    heap.push_back(open(first_child + 1, parent));
    std::push_heap(heap.begin(), heap.end(), is_less_urgent);
  }
  std::sort(heap.begin(), heap.end(), [&](const Open& x, const Open& y) {
    return clusters[x.cluster].begin < clusters[y.cluster].begin;
  });
  const auto share_of = [&](const Open& entry, std::size_t k) {
    return double(shares_of[std::size_t(entry.node)].of_pilot[k]);
  };
  std::array<double, light_cut_pilots> whole{};
  for (const Open& entry : heap)
    for (std::size_t k = 0; k < light_cut_pilots; ++k) whole[k] += share_of(entry, k);
  std::vector<double> shares, visibility(heap.size(), 1);
  std::vector<std::int32_t> of_cut;
  for (const Open& entry : heap) {
    shares.push_back(0);
    for (std::size_t k = 0; k < light_cut_pilots; ++k)
      if (whole[k] > 0) shares.back() += share_of(entry, k) / whole[k];
    of_cut.push_back(entry.node);
  }
  const bool has_shares = std::any_of(whole.begin(), whole.end(), [](double w) { return w > 0; });
  // Of fewer each gets several points of a pixel, seen or not.
  constexpr std::size_t few_clusters = 16;
  if (has_shares && heap.size() > few_clusters) {
    const std::vector<double> means = visibility_of<F>(tree, nodes, of_cut, shares, see);
    for (std::size_t e = 0; e < heap.size(); ++e) {
      visibility[e] = means[std::size_t(of_cut[e])];
      shares[e] *= share_left(visibility[e]);
    }
  }
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  // What no pilot has met may be lit by anything.
  const double defence = has_shares ? 0.1 : 1;
  // Shares are whole numbers: one that rounds to 0 would leave its lights out.
  constexpr double least_share = 0x1p-28;
  std::vector<CutCluster> cut;
  for (std::size_t e = 0; e < heap.size(); ++e) {
    const LightCluster& cluster = clusters[heap[e].cluster];
    const double weight = defence * double(cluster.power) / double(clusters[0].power) +
                          (has_shares ? (1 - defence) * shares[e] / sum : 0);
    cut.push_back({cluster.begin, cluster.power > 0 ? std::max(least_share, weight) : 0, visibility[e]});
  }
  return light_cut_of(cut, tree.facet_count());
}

}  // namespace etendue

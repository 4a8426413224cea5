// Cuts through a light tree, one for each small tile of the image: which clusters of lights matter there.
#pragma once

#include "light/inversion_table.h"
#include "lightsampler/light_choice.h"
#include "lightsampler/light_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace etendue {

/// A facet of those at the places [begin, end), in proportion to their power.
template <class F>
LightChoice<F> choose_by_power(const LightTree& tree, const Int<F>& begin, const Int<F>& end, const UInt<F>& u,
                               const F& pmf) {
  using I = Int<F>;
  const std::int32_t* shares = tree.shares();
  const I low = gather(shares, begin), size = gather(shares, end) - low;
  const UInt<F> scaled = mul_hi(u, as_uint(size));
  const I wanted = low + as_int(scaled);
  I first = begin, last = end - I(1);
  while (true) {
    const Mask<F> is_open = less(first, last);
    if (!any(is_open)) break;
    const I middle = (first + last + I(1)) >> 1;
    const Mask<F> is_above = less(wanted, gather(shares, middle));
    first = select(mask_and(is_open, mask_not(is_above)), middle, first);
    last = select(mask_and(is_open, is_above), middle - I(1), last);
  }
  const I from = gather(shares, first), part = gather(shares, first + I(1)) - from;
  // What is left of the number, below the whole shares too.
  const F below = to_unit_float(u * as_uint(size));
  const F u_left = min((to_float(wanted - from) + below) / max(to_float(part), F(1)), F(0x1.fffffep-1f));
  const I at = first * I(2);
  return {gather(&tree.facets()->light, at), gather(&tree.facets()->facet, at),
          as_uint(to_int(u_left * F(0x1p24f))) << 8, pmf * to_float(part) / max(to_float(size), F(1))};
}
template <class F>
F pmf_by_power(const LightTree& tree, const Int<F>& begin, const Int<F>& end, const Int<F>& place) {
  const std::int32_t* shares = tree.shares();
  const F part = to_float(gather(shares, place + Int<F>(1)) - gather(shares, place));
  return part / max(to_float(gather(shares, end) - gather(shares, begin)), F(1));
}

/// The cuts of the tiles that a block of samples touches. A cut depends on the scene and its tile alone, so no
/// bit of an image depends on how it is divided into blocks.
class LightCuts {
 public:
  static constexpr int tile_px = 8;
  static constexpr int most_clusters = 128;
  static constexpr int pilots = 16;  ///< Places of a tile that a cut is made for.

  /// Of the tiles of the next block; those that were there stay. Returns the slots that are new.
  std::vector<int> take_tiles(const std::vector<std::int32_t>& tiles) {
    std::vector<int> fresh;
    if (tiles == tiles_) return fresh;
    std::vector<Cut> cuts;
    for (const std::int32_t tile : tiles) {
      const auto old = std::find(tiles_.begin(), tiles_.end(), tile);
      if (old != tiles_.end())
        cuts.push_back(cuts_[std::size_t(old - tiles_.begin())]);
      else {
        fresh.push_back(int(cuts.size()));
        cuts.emplace_back();
      }
    }
    tiles_ = tiles;
    cuts_ = std::move(cuts);
    return fresh;
  }
  std::int32_t tile(int slot) const { return tiles_[std::size_t(slot)]; }

  /// Makes the cut for receivers that the tile's pilot rays have met. \param is_lit which of them count
  template <class F>
  void make(int slot, const LightTree& tree, const Receiver<F>* receivers, const Mask<F>* is_lit) {
    // How much each pilot gets of a cluster, all of them alike: relative to the whole tree.
    struct Open {
      std::int32_t cluster;
      float urgency;  ///< What may be gained by splitting it.
      std::array<float, pilots> shares;
    };
    constexpr int packets = pilots / lane_count_v<F>;
    const LightCluster* clusters = tree.clusters();
    std::array<F, packets> scale;
    bool is_any_lit = false;
    for (int p = 0; p < packets; ++p) {
      const F whole = importance(broadcast<F>(clusters[0]), receivers[p]).value;
      const Mask<F> counts = mask_and(is_lit[p], whole > F(0));
      is_any_lit = is_any_lit || any(counts);
      scale[std::size_t(p)] = select(counts, F(1) / select(counts, whole, F(1)), F(0));
    }
    const auto open = [&](std::int32_t cluster) {
      Open entry{cluster, 0, {}};
      alignas(64) std::array<float, pilots> lanes, spreads;
      const ClusterLanes<F> in_lanes = broadcast<F>(clusters[cluster]);
      for (int p = 0; p < packets; ++p) {
        const Importance<F> of = importance(in_lanes, receivers[p]);
        const F share = of.value * scale[std::size_t(p)];
        store_lanes(&lanes[std::size_t(p * lane_count_v<F>)], share);
        store_lanes(&spreads[std::size_t(p * lane_count_v<F>)], share * of.spread_sq);
      }
      float share = 0, spread = 0;
      for (std::size_t k = 0; k < pilots; ++k) {
        share += lanes[k];
        spread += spreads[k];
      }
      entry.shares = lanes;
      if (clusters[cluster].first_child > 0)
        entry.urgency = spread + share * (0.02f + 0.25f * (1 - clusters[cluster].cos_normals));
      return entry;
    };
    const auto is_less_urgent = [](const Open& a, const Open& b) { return a.urgency < b.urgency; };
    std::vector<Open> heap{open(0)};
    while (heap.size() < most_clusters && is_any_lit && heap.front().urgency > 0) {
      const std::int32_t first_child = clusters[heap.front().cluster].first_child;
      std::pop_heap(heap.begin(), heap.end(), is_less_urgent);
      heap.back() = open(first_child);
      std::push_heap(heap.begin(), heap.end(), is_less_urgent);
      heap.push_back(open(first_child + 1));
      std::push_heap(heap.begin(), heap.end(), is_less_urgent);
    }
    std::sort(heap.begin(), heap.end(), [&](const Open& a, const Open& b) {
      return clusters[a.cluster].begin < clusters[b.cluster].begin;
    });
    std::array<double, pilots> whole{};
    for (const Open& entry : heap)
      for (std::size_t k = 0; k < pilots; ++k) whole[k] += double(entry.shares[k]);
    int lit = 0;
    for (const double w : whole) lit += w > 0;
    // What no pilot has met may be lit by anything.
    const double defence = lit > 0 ? 0.1 : 1;
    std::vector<double> weights(most_clusters);
    Cut& cut = cuts_[std::size_t(slot)];
    cut.places.fill(tree.facet_count());
    for (std::size_t e = 0; e < heap.size(); ++e) {
      const LightCluster& cluster = clusters[heap[e].cluster];
      cut.places[e] = cluster.begin;
      double seen = 0;
      for (std::size_t k = 0; k < pilots; ++k)
        if (whole[k] > 0) seen += double(heap[e].shares[k]) / whole[k];
      weights[e] = defence * double(cluster.power) / double(clusters[0].power) +
                   (lit > 0 ? (1 - defence) * seen / lit : 0);
    }
    std::vector<std::int32_t> shares;
    append_cumulative_shares(weights, shares);
    std::copy(shares.begin(), shares.end(), cut.shares.begin());
  }

  template <class F>
  LightChoice<F> choose(const LightTree& tree, const Int<F>& slot, const UInt<F>& u, const F& pmf) const {
    const Int<F> first = slot * Int<F>(cut_words);
    const InversionSample<F> cluster =
        sample_by_inversion<F>(cuts_[0].shares.data(), first, most_clusters, u);
    const F of_cluster = inversion_pmf<F>(cuts_[0].shares.data(), first, cluster.index);
    const Int<F> begin = gather(cuts_[0].places.data(), first + cluster.index),
                 end = gather(cuts_[0].places.data(), first + cluster.index + Int<F>(1));
    // Low bits of the number that the shares of clusters do not use are lost: made from the others.
    const UInt<F> noise = u * UInt<F>(0x9e3779b9u);
    const UInt<F> u_left = (as_uint(to_int(cluster.u_left * F(0x1p24f))) << 8) | (noise >> 24);
    return choose_by_power<F>(tree, begin, end, u_left, pmf * of_cluster);
  }

  template <class F>
  F pmf(const LightTree& tree, const Int<F>& slot, const Int<F>& place) const {
    using I = Int<F>;
    const I first = slot * I(cut_words);
    I index(0);
    for (int step = most_clusters / 2; step > 0; step /= 2) {
      const I probe = index + I(step);
      index = select(less(place, gather(cuts_[0].places.data(), first + probe)), index, probe);
    }
    const I begin = gather(cuts_[0].places.data(), first + index),
            end = gather(cuts_[0].places.data(), first + index + I(1));
    return inversion_pmf<F>(cuts_[0].shares.data(), first, index) * pmf_by_power<F>(tree, begin, end, place);
  }

 private:
  /// Clusters from left to right; those that are not needed hold no place.
  struct Cut {
    std::array<std::int32_t, most_clusters + 1> shares, places;
  };
  static constexpr int cut_words = sizeof(Cut) / sizeof(std::int32_t);
  static_assert((most_clusters & (most_clusters - 1)) == 0);

  std::vector<std::int32_t> tiles_;
  std::vector<Cut> cuts_;
};

}  // namespace etendue

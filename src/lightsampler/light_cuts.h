// Cuts through a light tree, one for each small tile of the image: which clusters of lights matter there.
#pragma once

#include "light/inversion_table.h"
#include "lightsampler/light_choice.h"
#include "lightsampler/light_tree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace etendue {

/// A facet of those at the places [begin, end), in proportion to their power.
template <class F>
LightChoice<F> choose_by_power(const LightTree& tree, const Int<F>& begin, const Int<F>& end,
                               const UInt<F>& u, const F& pmf) {
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

/// One cut. It depends on the scene and its tile alone, so no bit of an image depends on how it is divided
/// into blocks.
struct LightCut {
  static constexpr int tile_px = 8;
  static constexpr int most_clusters = 256;
  static constexpr int guide_shift = 24, guides = 1 << (32 - guide_shift);

  /// Clusters from left to right: cumulative shares (light/inversion_table.h), and the places of the tree
  /// where they begin. Those that are not needed hold no place.
  std::array<std::int32_t, most_clusters + 1> shares, places;
  std::array<std::int32_t, guides> guide;  ///< For the high bits of a number, where to look for its cluster.
};

/// The cuts of a render that have been made, shared by its threads; in a large image not all are kept.
class LightCutStore {
 public:
  explicit LightCutStore(int tiles) : cuts_(std::size_t(std::min(tiles, most_kept))) {}
  LightCutStore(const LightCutStore&) = delete;
  LightCutStore& operator=(const LightCutStore&) = delete;
  ~LightCutStore() {
    for (const auto& cut : cuts_) delete cut.load();
  }

  /// Null where it has not been kept.
  const LightCut* find(std::int32_t tile) const {
    return std::size_t(tile) < cuts_.size() ? cuts_[std::size_t(tile)].load(std::memory_order_acquire)
                                            : nullptr;
  }
  void keep(std::int32_t tile, const LightCut& cut) {
    if (std::size_t(tile) >= cuts_.size()) return;
    auto kept = std::make_unique<const LightCut>(cut);
    const LightCut* none = nullptr;  // Another thread may have been first, with the same.
    if (cuts_[std::size_t(tile)].compare_exchange_strong(none, kept.get(), std::memory_order_acq_rel))
      kept.release();
  }

 private:
  static constexpr int most_kept = 1 << 16;  ///< 200 MB.
  std::vector<std::atomic<const LightCut*>> cuts_;
};

/// The cuts of the tiles that a block of samples touches.
class LightCuts {
 public:
  static constexpr int most_clusters = LightCut::most_clusters;
  static int tiles_across(int pixels) { return (pixels + LightCut::tile_px - 1) / LightCut::tile_px; }
  static constexpr int pilots = 16;  ///< Places of a tile that a cut is made for.

  /// Takes the cuts of the next block's tiles: those that the last block had, those that are kept, and what
  /// make(slot, tile) makes.
  template <class Make>
  void take_tiles(const std::vector<std::int32_t>& tiles, LightCutStore* store, const Make& make) {
    if (tiles == tiles_) return;
    std::vector<LightCut> cuts(tiles.size());
    std::vector<int> missing;
    for (std::size_t slot = 0; slot < tiles.size(); ++slot) {
      const auto old = std::find(tiles_.begin(), tiles_.end(), tiles[slot]);
      const LightCut* kept = store ? store->find(tiles[slot]) : nullptr;
      if (old != tiles_.end())
        cuts[slot] = cuts_[std::size_t(old - tiles_.begin())];
      else if (kept)
        cuts[slot] = *kept;
      else
        missing.push_back(int(slot));
    }
    tiles_ = tiles;
    cuts_ = std::move(cuts);
    for (const int slot : missing) {
      make(slot, tiles[std::size_t(slot)]);
      if (store) store->keep(tiles[std::size_t(slot)], cuts_[std::size_t(slot)]);
    }
  }

  /// Makes the cut for receivers that the tile's pilot rays have met. \param is_lit which of them count
  /// \param scattered(p, importance) how much the packet p of them scatters of a cluster's light, relative to
  /// that of others
  template <class F, class Scattered>
  void make(int slot, const LightTree& tree, const Receiver<F>* receivers, const Mask<F>* is_lit,
            const Scattered& scattered) {
    // How much each pilot gets of a cluster, all of them alike: relative to the whole tree.
    constexpr int packets = pilots / lane_count_v<F>;
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
      std::array<float, pilots> of_pilot;
    };
    struct Open {
      float urgency;  ///< What may be gained by splitting it.
      std::int32_t cluster, shares;
    };
    static thread_local std::vector<Shares> shares_of(2 * most_clusters);
    std::int32_t opened = 0;
    const auto open = [&](std::int32_t cluster) {
      const ClusterLanes<F> in_lanes = broadcast<F>(clusters[cluster]);
      float* shares = shares_of[std::size_t(opened)].of_pilot.data();
      alignas(64) std::array<float, pilots> spreads;
      for (int p = 0; p < packets; ++p) {
        const Importance<F> of = importance(in_lanes, receivers[p]);
        const F share = of.value * scale[std::size_t(p)] * scattered(p, of);
        store_lanes(shares + p * lane_count_v<F>, share);
        store_lanes(&spreads[std::size_t(p * lane_count_v<F>)], share * of.spread_sq);
      }
      float share = 0, spread = 0;
      for (int k = 0; k < pilots; ++k) {
        share += shares[k];
        spread += spreads[std::size_t(k)];
      }
      const bool is_leaf = clusters[cluster].first_child == 0;
      const float urgency = spread + share * (0.02f + 0.25f * (1 - clusters[cluster].cos_normals));
      return Open{is_leaf ? 0 : urgency, cluster, opened++};
    };
    const auto is_less_urgent = [](const Open& x, const Open& y) { return x.urgency < y.urgency; };
    std::vector<Open> heap{open(0)};
    while (heap.size() < most_clusters && is_any_lit && heap.front().urgency > 0) {
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
    std::array<double, pilots> whole{};
    for (const Open& entry : heap)
      for (std::size_t k = 0; k < pilots; ++k) whole[k] += share_of(entry, k);
    int lit = 0;
    for (const double w : whole) lit += w > 0;
    // What no pilot has met may be lit by anything.
    const double defence = lit > 0 ? 0.1 : 1;
    // Shares are whole numbers: one that rounds to 0 would leave its lights out.
    constexpr double least_share = 0x1p-28;
    std::vector<double> weights(most_clusters);
    LightCut& cut = cuts_[std::size_t(slot)];
    cut.places.fill(tree.facet_count());
    for (std::size_t e = 0; e < heap.size(); ++e) {
      const LightCluster& cluster = clusters[heap[e].cluster];
      cut.places[e] = cluster.begin;
      double seen = 0;
      for (std::size_t k = 0; k < pilots; ++k)
        if (whole[k] > 0) seen += share_of(heap[e], k) / whole[k];
      const double weight = defence * double(cluster.power) / double(clusters[0].power) +
                            (lit > 0 ? (1 - defence) * seen / lit : 0);
      weights[e] = cluster.power > 0 ? std::max(weight, least_share) : 0;
    }
    std::vector<std::int32_t> shares;
    append_cumulative_shares(weights, shares);
    std::copy(shares.begin(), shares.end(), cut.shares.begin());
    for (std::int32_t g = 0, e = 0; g < LightCut::guides; ++g) {
      while (e + 1 < most_clusters &&
             cut.shares[std::size_t(e + 1)] <= g * (inversion_whole / LightCut::guides))
        ++e;
      cut.guide[std::size_t(g)] = e;
    }
  }

  template <class F>
  LightChoice<F> choose(const LightTree& tree, const Int<F>& slot, const UInt<F>& u, const F& pmf) const {
    const Int<F> first = slot * Int<F>(cut_words);
    const std::int32_t *shares = cuts_[0].shares.data(), *places = cuts_[0].places.data();
    const Int<F> wanted = as_int(u >> 2);
    Int<F> at = first + gather(cuts_[0].guide.data(), first + as_int(u >> LightCut::guide_shift));
    Int<F> end_share = gather(shares, at + Int<F>(1));
    while (true) {
      const Mask<F> is_beyond = mask_not(less(wanted, end_share));
      if (!any(is_beyond)) break;
      at = select(is_beyond, at + Int<F>(1), at);
      end_share = gather(shares, at + Int<F>(1));
    }
    const Int<F> begin_share = gather(shares, at);
    const F size = to_float(end_share - begin_share);
    const UInt<F> noise = u * UInt<F>(0x9e3779b9u);
    const F within = min((to_float(wanted - begin_share) + to_unit_float(noise)) / size, F(0x1.fffffep-1f));
    // Low bits that the shares of clusters do not leave are made from those that there are.
    const UInt<F> u_left = (as_uint(to_int(within * F(0x1p24f))) << 8) | (noise >> 24);
    return choose_by_power<F>(tree, gather(places, at), gather(places, at + Int<F>(1)), u_left,
                              pmf * (size * F(1.0f / float(inversion_whole))));
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
  static constexpr int cut_words = sizeof(LightCut) / sizeof(std::int32_t);
  static_assert((most_clusters & (most_clusters - 1)) == 0);

  std::vector<std::int32_t> tiles_;
  std::vector<LightCut> cuts_;
};

}  // namespace etendue

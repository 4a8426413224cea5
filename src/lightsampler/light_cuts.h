// The cuts of the light tree that a block of samples works with, and choices by them.
#pragma once

#include "light/inversion_table.h"
#include "lightsampler/facets_by_power.h"
#include "lightsampler/light_cut.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace etendue {

/// The cuts of the tiles that a block of samples touches.
class LightCuts {
 public:
  static constexpr int most_clusters = LightCut::most_clusters;
  static int tiles_across(int pixels) { return (pixels + LightCut::tile_px - 1) / LightCut::tile_px; }

  /// Takes the cuts of the next block's tiles: those that the last block had, those that are kept, and what
  /// make(tile) makes.
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
      cuts_[std::size_t(slot)] = make(tiles[std::size_t(slot)]);
      if (store) store->keep(tiles[std::size_t(slot)], cuts_[std::size_t(slot)]);
    }
  }

  /// A facet, by the cut in the slot of each lane. \param pmf with which the tree was chosen
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
    const Int<F> cluster = first + gather(cuts_[0].clusters.data(), at);
    return choose_by_power<F>(tree, gather(places, cluster), gather(places, cluster + Int<F>(1)), u_left,
                              pmf * (size * F(1.0f / float(inversion_whole))));
  }

  /// The probability of the facet at a place of the tree.
  template <class F>
  F pmf(const LightTree& tree, const Int<F>& slot, const Int<F>& place) const {
    using I = Int<F>;
    const I first = slot * I(cut_words);
    I cluster(0);
    for (int step = most_clusters / 2; step > 0; step /= 2) {
      const I probe = cluster + I(step);
      cluster = select(less(place, gather(cuts_[0].places.data(), first + probe)), cluster, probe);
    }
    const I begin = gather(cuts_[0].places.data(), first + cluster),
            end = gather(cuts_[0].places.data(), first + cluster + I(1)),
            position = gather(cuts_[0].positions.data(), first + cluster);
    return inversion_pmf<F>(cuts_[0].shares.data(), first, position) *
           pmf_by_power<F>(tree, begin, end, place);
  }

 private:
  static constexpr int cut_words = sizeof(LightCut) / sizeof(std::int32_t);
  static_assert((most_clusters & (most_clusters - 1)) == 0);

  std::vector<std::int32_t> tiles_;
  std::vector<LightCut> cuts_;
};

}  // namespace etendue

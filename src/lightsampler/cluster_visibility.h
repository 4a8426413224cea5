// How much of a cut's clusters the pilots of its tile see.
#pragma once

#include "base/hash.h"
#include "lightsampler/facets_by_power.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

inline constexpr int light_cut_pilots = 16;  ///< Places of a tile that a cut is made for.

/// A cluster that was looked at while a cut was made; nodes stand behind their parents, the root is the
/// first.
struct CutNode {
  std::int32_t cluster, parent;  ///< The parent is a node.
};

/// The shadow rays of pilots, counted for each node.
class ClusterVisibility {
 public:
  explicit ClusterVisibility(std::span<const CutNode> nodes)
      : nodes_(nodes), asked_(nodes.size()), free_(nodes.size()) {}

  void count(std::int32_t node, bool is_free) {
    asked_[std::size_t(node)] += 1;
    free_[std::size_t(node)] += is_free ? 1 : 0;
    has_met_something_ = has_met_something_ || !is_free;
  }
  bool has_met_something() const { return has_met_something_; }

  /// For each node the mean of its rays and, as often as two rays, its parent's mean: what is not looked at
  /// enough is taken for what stands around it. 1 where no ray has met anything.
  std::vector<double> means() const;

 private:
  std::span<const CutNode> nodes_;
  std::vector<double> asked_, free_;
  bool has_met_something_ = false;
};

/// The factor that the share of a cluster keeps, of which the pilots see so much, 1/8 to 1: the root of that,
/// with which independent samples have least noise; but all where it is a quarter, as half-seen clusters are
/// where stratified samples have noise, and not nothing for what only other places of the tile see.
double share_left(double visibility);

template <class F>
struct SeenLight {
  Mask<F> is_asked;  ///< Elsewhere there was nothing to see, whatever stands between.
  Mask<F> is_free;
};

/// Casts up to 16 shadow rays from each pilot to clusters of a cut, chosen in proportion to their shares,
/// each of them from pilots all over the tile; 4 where they meet nothing. \param of_cut the nodes that the
/// cut consists of \param shares theirs \param see(p, choice, u_place) whether the packet p of pilots sees a
/// point of the facets that have been chosen
template <class F, class See>
std::vector<double> visibility_of(const LightTree& tree, std::span<const CutNode> nodes,
                                  std::span<const std::int32_t> of_cut, std::span<const double> shares,
                                  const See& see) {
  constexpr int pilots = light_cut_pilots, rounds = 16, first_rounds = 4;
  std::vector<double> cumulative;
  double whole = 0;
  for (const double share : shares) cumulative.push_back(whole += share);
  ClusterVisibility visibility(nodes);
  for (int round = 0; round < rounds; ++round) {
    if (round == first_rounds && !visibility.has_met_something()) break;
    std::array<std::int32_t, pilots> aims;
    alignas(64) std::array<std::int32_t, pilots> begin, end, is_asked, is_free;
    alignas(64) std::array<std::uint32_t, pilots> u_facet;
    for (int k = 0; k < pilots; ++k) {
      // A pilot goes through all sixteenths of the shares, and a sixteenth is seen from all pilots; odd
      // factors permute them.
      const int sixteenth = k ^ (3 * round % 16), within = 5 * round % 16;
      const double wanted = whole * (sixteenth * 16 + within + 0.5) / 256;
      const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, wanted);
      const auto at = std::size_t(k);
      aims[at] = of_cut[std::size_t(found - cumulative.begin())];
      const LightCluster& cluster = tree.clusters()[nodes[std::size_t(aims[at])].cluster];
      begin[at] = cluster.begin;
      end[at] = cluster.end;
      u_facet[at] = hash32(std::uint32_t(round * pilots + k));
    }
    for (int i = 0; i < pilots; i += lane_count_v<F>) {
      const auto at = std::size_t(i);
      const UInt<F> u = load_lanes<UInt<F>>(&u_facet[at]);
      const LightChoice<F> choice =
          choose_by_power<F>(tree, load_lanes<Int<F>>(&begin[at]), load_lanes<Int<F>>(&end[at]), u, F(1));
      const SeenLight<F> seen = see(i / lane_count_v<F>, choice, hash32(u));
      store_mask<F>(&is_asked[at], seen.is_asked);
      store_mask<F>(&is_free[at], seen.is_free);
    }
    for (std::size_t k = 0; k < pilots; ++k)
      if (is_asked[k] != 0) visibility.count(aims[k], is_free[k] != 0);
  }
  return visibility.means();
}

}  // namespace etendue

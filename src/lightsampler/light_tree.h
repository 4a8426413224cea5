// A binary tree over the facets of all lights that have a place.
#pragma once

#include "light/light.h"
#include "lightsampler/light_importance.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// A facet by the light that it belongs to.
struct LightFacet {
  std::int32_t light, facet;
};

/// Clusters are split in two so that both have little power, little extent and normals of one direction: the
/// orientation heuristic of Conty Estevez and Kulla 2018, section 4.4, in 16 bins. Deviation: what the cone
/// is there, is here 2 less the length of the mean normal, which sums of bins give at once; what the area is,
/// the square of the box's diagonal, as flat clusters are not small.
class LightTree {
 public:
  explicit LightTree(const Lights& lights);

  bool is_empty() const { return facets_.empty(); }
  std::int32_t facet_count() const { return std::int32_t(facets_.size()); }
  const LightCluster* clusters() const { return clusters_.data(); }  ///< The root is the first.
  std::int32_t cluster_count() const { return std::int32_t(clusters_.size()); }

  // By place: facets as they stand in the tree from left to right.
  const LightFacet* facets() const { return facets_.data(); }
  /// Cumulative shares of power, see light/inversion_table.h; none is 0 but of what has no power.
  const std::int32_t* shares() const { return shares_.data(); }
  /// For the high bits of a cumulative share, the last facet that begins at or before it; one entry more than
  /// there are values of these bits, `share >> guide_shift()`.
  const std::int32_t* guide() const { return guide_.data(); }
  int guide_shift() const { return guide_shift_; }
  const std::int32_t* leaves() const { return leaves_.data(); }  ///< The cluster that holds it.

  /// The place of a facet; lights must have one.
  template <class F>
  Int<F> place_of(const Int<F>& light, const Int<F>& facet) const {
    return gather(places_.data(), gather(first_of_light_.data(), light) + facet);
  }

  /// Of a place among most_ranks at most: neighbours have the same, or the next.
  static constexpr std::int32_t most_ranks = 1 << 14;
  std::int32_t ranks() const { return ((facet_count() - 1) >> rank_shift_) + 1; }
  template <class F>
  Int<F> rank_of(const Int<F>& place) const {
    return place >> rank_shift_;
  }

  /// Lights that shine from everywhere have no place in the tree.
  const std::vector<std::int32_t>& lights_beside() const { return beside_; }
  template <class F>
  Mask<F> is_beside(const Int<F>& light) const {
    return less(gather(first_of_light_.data(), light), Int<F>(0));
  }

 private:
  std::vector<LightCluster> clusters_;
  std::vector<LightFacet> facets_;
  std::vector<std::int32_t> shares_, guide_, leaves_;
  int guide_shift_ = 0, rank_shift_ = 0;
  std::vector<std::int32_t> first_of_light_;  ///< Into places_; -1: beside.
  std::vector<std::int32_t> places_;          ///< Of the facets of light 0, of light 1 ...
  std::vector<std::int32_t> beside_;
};

}  // namespace etendue

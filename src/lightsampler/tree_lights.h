// Which light, and which facet of it: by a walk down the light tree, and at what the camera sees by a cut of
// it.
#pragma once

#include "lightsampler/light_choice.h"
#include "lightsampler/light_cuts.h"
#include "lightsampler/light_tree.h"

#include <memory>

namespace etendue {

/// Lights without a place stand beside the tree: each is chosen as often as the whole tree.
class TreeLights {
 public:
  explicit TreeLights(const Lights& lights) : tree_(std::make_shared<const LightTree>(lights)) {}

  static constexpr bool chooses_facets = true;
  std::int32_t passes() const { return 1; }
  std::int32_t ranks() const { return tree_->ranks() + std::int32_t(tree_->lights_beside().size()); }
  const LightTree& tree() const { return *tree_; }

  template <class F>
  LightChoice<F> choose(const Receiver<F>& receiver, const UInt<F>& u, std::int32_t /*pass*/) const {
    const auto& beside = tree_->lights_beside();
    const auto alike = std::uint32_t(beside.size()) + (tree_->is_empty() ? 0u : 1u);
    if (beside.empty()) return choose_in_tree<F>(receiver, u, F(1));
    const Int<F> which = as_int(mul_hi(u, UInt<F>(alike)));
    const UInt<F> u_left = u * UInt<F>(alike);
    const F pmf(1.0f / float(alike));
    const Mask<F> is_in_tree = mask_not(less(which, Int<F>(std::int32_t(beside.size()))));
    const Int<F> light = gather(beside.data(), select(is_in_tree, Int<F>(0), which));
    LightChoice<F> choice{light, Int<F>(0), u_left, pmf, Int<F>(tree_->ranks()) + which};
    return any(is_in_tree) ? select(is_in_tree, choose_in_tree<F>(receiver, u_left, pmf), choice) : choice;
  }

  template <class F>
  F pmf(const Receiver<F>& receiver, const Int<F>& light, const Int<F>& facet) const {
    const auto& beside = tree_->lights_beside();
    const auto alike = std::uint32_t(beside.size()) + (tree_->is_empty() ? 0u : 1u);
    const F one(1.0f / float(alike));
    const Mask<F> is_beside = tree_->is_beside<F>(light);
    if (all(is_beside)) return one;
    const Int<F> safe = select(is_beside, Int<F>(tree_->facets()->light), light);
    const Int<F> place = tree_->place_of<F>(safe, select(is_beside, Int<F>(0), facet));
    return select(is_beside, one, one * pmf_in_tree<F>(receiver, place));
  }

 private:
  template <class F>
  LightChoice<F> choose_in_tree(const Receiver<F>& receiver, const UInt<F>& u, const F& pmf) const {
    if (receiver.cuts) return receiver.cuts->template choose<F>(*tree_, receiver.cut, u, pmf);
    return walk<F>(receiver, u, pmf);
  }
  template <class F>
  F pmf_in_tree(const Receiver<F>& receiver, const Int<F>& place) const {
    if (receiver.cuts) return receiver.cuts->template pmf<F>(*tree_, receiver.cut, place);
    return pmf_of_walk<F>(receiver, place);
  }

  /// The probability of the first of two children, in 2^-31; where both matter, neither has less than 2^-20:
  /// what is hidden must not be all that is ever chosen. 0 for both where nothing arrives.
  template <class F>
  static Int<F> first_share(const F& first, const F& second) {
    const F sum = first + second;
    const F share = first / select(sum > F(0), sum, F(1));
    const Int<F> least(1 << 11), whole_less(0x7fffffff - (1 << 11));
    const Int<F> scaled = to_int(min(share, F(0x1.fffffep-1f)) * F(0x1p31f));
    Int<F> clamped = select(less(scaled, least), least, select(less(whole_less, scaled), whole_less, scaled));
    clamped = select(second > F(0), clamped, Int<F>(0x7fffffff));
    return select(first > F(0), clamped, Int<F>(0));
  }
  template <class F>
  Int<F> first_share_at(const Receiver<F>& receiver, const Int<F>& first_child, Mask<F>& is_dark) const {
    const F first = importance(gather_clusters<F>(tree_->clusters(), first_child), receiver).value;
    const F second =
        importance(gather_clusters<F>(tree_->clusters(), first_child + Int<F>(1)), receiver).value;
    is_dark = mask_not(first + second > F(0));
    return first_share(first, second);
  }
  static constexpr std::int32_t cluster_words = sizeof(LightCluster) / sizeof(std::int32_t);

  template <class F>
  LightChoice<F> walk(const Receiver<F>& receiver, UInt<F> u, F pmf) const {
    using I = Int<F>;
    using U = UInt<F>;
    const LightCluster* clusters = tree_->clusters();
    I at(0);
    while (true) {
      const I child = gather(&clusters->first_child, at * I(cluster_words));
      const Mask<F> is_inner = mask_and(less(I(0), child), pmf > F(0));
      if (!any(is_inner)) break;
      const I safe = select(is_inner, child, I(tree_->cluster_count() > 1 ? 1 : 0));
      Mask<F> is_dark = is_inner;
      const I share = first_share_at<F>(receiver, safe, is_dark);
      const I u31 = as_int(u >> 1);
      const Mask<F> is_first = less(u31, share);
      const I part = select(is_first, share, I(0x7fffffff) - share);
      const F p = select(is_dark, F(0), to_float(part) * F(0x1p-31f));
      pmf = select(is_inner, pmf * p, pmf);
      at = select(mask_and(is_inner, mask_not(is_dark)), child + select(is_first, I(0), I(1)), at);
      // Stretched back; bits that few values have not are made from those that they have.
      const U noise = u * U(0x9e3779b9u);
      const F within = to_float(u31 - select(is_first, I(0), share)) + to_unit_float(noise);
      const F u_left = min(within / max(to_float(part), F(1)), F(0x1.fffffep-1f));
      const U stretched = (as_uint(to_int(u_left * F(0x1p24f))) << 8) | (noise >> 24);
      u = as_uint(select(is_inner, as_int(stretched), as_int(u)));
    }
    const I begin = gather(&clusters->begin, at * I(cluster_words)),
            end = gather(&clusters->end, at * I(cluster_words));
    return choose_by_power<F>(*tree_, begin, end, u, pmf);
  }

  template <class F>
  F pmf_of_walk(const Receiver<F>& receiver, const Int<F>& place) const {
    using I = Int<F>;
    const LightCluster* clusters = tree_->clusters();
    I at = gather(tree_->leaves(), place);
    F pmf = pmf_by_power<F>(*tree_, gather(&clusters->begin, at * I(cluster_words)),
                            gather(&clusters->end, at * I(cluster_words)), place);
    while (true) {
      const Mask<F> is_below = less(I(0), at);
      if (!any(is_below)) return pmf;
      const I parent = select(is_below, gather(&clusters->parent, at * I(cluster_words)), I(0));
      const I first_child = gather(&clusters->first_child, parent * I(cluster_words));
      Mask<F> is_dark = is_below;
      const I share = first_share_at<F>(receiver, first_child, is_dark);
      const I part = select(equal(at, first_child), share, I(0x7fffffff) - share);
      pmf = select(is_below, pmf * select(is_dark, F(0), to_float(part) * F(0x1p-31f)), pmf);
      at = parent;
    }
  }

  std::shared_ptr<const LightTree> tree_;
};

}  // namespace etendue

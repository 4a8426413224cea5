// A cut through the light tree, for one small tile of the image: which clusters of lights matter there.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace etendue {

/// One cut. It depends on the scene and its tile alone, so no bit of an image depends on how it is divided
/// into blocks.
struct LightCut {
  static constexpr int tile_px = 8;
  static constexpr int most_clusters = 256;
  static constexpr int guide_shift = 24, guides = 1 << (32 - guide_shift);

  /// Clusters from left to right: the places of the tree where they begin. Those that are not needed hold no
  /// place.
  std::array<std::int32_t, most_clusters + 1> places;
  /// Cumulative shares (light/inversion_table.h), first of the clusters that are seen, then of the others:
  /// each change between what counts and what does not costs noise.
  std::array<std::int32_t, most_clusters + 1> shares;
  std::array<std::int32_t, most_clusters> clusters;   ///< Whose share it is.
  std::array<std::int32_t, most_clusters> positions;  ///< The inverse: where a cluster has its share.
  std::array<std::int32_t, guides> guide;  ///< For the high bits of a number, where to look for its share.
};

/// What a cut is made of.
struct CutCluster {
  std::int32_t begin;  ///< The first of its places.
  double weight;       ///< How often it is chosen, relative to others; 0: never.
  double visibility;   ///< From the pilots, out of 1.
};
/// \param clusters from left to right, up to LightCut::most_clusters \param facets of the tree
LightCut light_cut_of(std::span<const CutCluster> clusters, std::int32_t facets);

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
  static constexpr int most_kept = 1 << 16;  ///< 340 MB.
  std::vector<std::atomic<const LightCut*>> cuts_;
};

}  // namespace etendue

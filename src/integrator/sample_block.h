// A block of samples as structure-of-arrays buffers that stay in the cache; integrators' stages pass over it.
#pragma once

#include "integrator/block_counts.h"
#include "integrator/columns.h"
#include "integrator/layer_set.h"
#include "integrator/shadow_rays.h"
#include "lightsampler/light_cuts.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

/// The paths that are still alive, one a row, as they arrive at a vertex.
struct PathColumns {
  int count = 0;         ///< Paths.
  int padded_count = 0;  ///< Up to whole packets of the widest kind.

  Column<std::int32_t> sample;  ///< The row of the sample that the path belongs to.
  Column<std::uint32_t> stream_lo, stream_hi, index;

  RayColumns ray;  ///< The ray that arrives, and what it hits.
  HitColumns hit;
  ColorColumn throughput;  ///< Product of f cos / pdf, roulette included.
  /// Of the ray's direction, 1/sr; infinity: the camera's, or a Dirac delta's; 0: light samples alone find
  /// the light that it meets.
  Column<float> pdf;
  Column<float> eta;  ///< Refractive index here over that at the camera.
  /// The vertex where the ray was sampled; kept only where weights need it.
  ReceiverColumns receiver;
};

struct SampleBlock;

/// Benchmarks and replays look on. `vertex` is the number of the vertex.
struct BlockWatcher {
  /// The shadow rays of one light sample have been cast: the k-th of those that the block holds.
  std::function<void(const SampleBlock&, const LightSampleNumber&, int k)> on_light_sample;
  /// The samples of a vertex have been taken; of several BSDF samples at the first vertex, each of which goes
  /// on to vertices of its own, which one.
  std::function<void(const SampleBlock&, int vertex, int branch)> on_vertex;
};

struct SampleBlock {
  // The samples of a block, and what becomes of them; the surplus of the padding repeats the last sample.
  int count = 0;
  int padded_count = 0;
  bool is_one_pixel = false;
  Column<std::int32_t> pixel_x, pixel_y;
  Column<float> filter_weight;  ///< Set and read only where the pixel filter has negative lobes.
  ColorColumn radiance;
  std::span<const LayerSet> layer_sets;
  std::vector<ColorColumn> layers;  ///< Parts of the radiance, of one set after the other; mostly none.

  /// -1 where a sample's lamps at vertex 0 come from rays of their own, 0 elsewhere; set where there are any.
  Column<std::int32_t> is_at_outline;
  bool has_outlines = false;

  PathColumns path;
  bool is_in_sample_order = true;  ///< Row i of `path` is sample i: no path has been left out yet.

  LightCuts cuts;                      ///< Of the tiles that the samples belong to; mostly none.
  LightCutStore* cut_store = nullptr;  ///< Of the render, where there is one.
  Column<std::int32_t> cut;            ///< Which of them.
  bool has_cuts = false;

  ShadowRays shadow;

  Column<std::int32_t> kept;  ///< Rows of `path` that go on.

  RayColumns next_ray;  ///< Along the direction that the BSDF was sampled for.

  BlockCounts counts;
  StageClock clock;
  const BlockWatcher* watcher = nullptr;
};

}  // namespace etendue

// Scene -> Film: its settings, its progress, what it counted.
#pragma once

#include "film/film.h"
#include "film/replicate_luminances.h"
#include "film/sample_allocation.h"
#include "integrator/block_counts.h"
#include "integrator/integrator.h"
#include "integrator/layer_set.h"
#include "render/invalid_samples.h"
#include "render/isa.h"
#include "sampler/replicates.h"
#include "scene/scene.h"
#include "stats/largest_values.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace etendue {

/// How to render; what is not given comes from the scene file.
struct RenderSettings {
  IntegratorSettings integrator;
  int samples_per_pixel = 16;     ///< In all, over all replicates.
  std::optional<int> replicates;  ///< Must divide samples_per_pixel; default_replicates unless given.
  /// Of the image's size, where pixels take different numbers of samples: samples_per_pixel is then theirs on
  /// average, or about.
  std::optional<SampleAllocation> allocation{};
  ReplicatesBy replicates_by = ReplicatesBy::block;
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0: all that the process may use.
  Isa isa = Isa::scalar;
  bool is_reordering = true;            ///< Aim shadow packets; off only to show that it changes nothing.
  std::vector<LayerSet> layers;         ///< Parts of the image to be kept apart; each costs time and memory.
  std::optional<LayerSet> noise_parts;  ///< Parts of which only the noise is to be known.
  /// Keep the luminances of the first layer's replicates, not of the image's.
  bool keeps_luminances_of_layer = false;

  int replicate_count() const { return replicates.value_or(default_replicates(samples_per_pixel)); }
  int samples_per_replicate() const { return samples_per_pixel / replicate_count(); }
  const SampleAllocation* allocation_or_null() const { return allocation ? &*allocation : nullptr; }
  int samples_per_replicate_of(int x, int y) const {
    return allocation ? allocation->at(x, y) : samples_per_replicate();
  }
};

struct RenderCounts : BlockCounts {
  std::int64_t samples = 0;  ///< All counts are of what is in the film.

  /// The mean fraction of the lanes of a packet that hold a living path.
  double lane_occupancy() const { return lanes > 0 ? double(paths) / double(lanes) : 0; }
};

/// What a part of the image has of its noise.
struct PartNoise {
  /// Its covariance with the image over the variance of the image, by the luminances of replicates, summed
  /// over pixels: of all parts together 1, of one below 0 where it makes up for what others have too much.
  /// NaN where no variance is known.
  double variance_share;
  LargestValues largest;  ///< Luminances of its samples, without the pixel filter's weights.
};

struct RenderResult {
  Film film;  ///< Where interrupted, of `replicates` replicates; of a fragment, some pixels have count 0.
  std::vector<Film> layers{};      ///< Of one set after the other, of the same pixels and replicates.
  std::vector<PartNoise> noise{};  ///< Of each of the settings' noise_parts.
  int replicates = 0;
  /// Of the image, or of its first layer, as the settings say; the first `replicates` count.
  ReplicateLuminances luminances{};
  RenderCounts counts{};
  InvalidSamples invalid{};
  double seconds = 0;
  bool is_interrupted = false;  ///< There are fewer replicates than asked for.
  bool is_fragment = false;     ///< Some pixels were not rendered.
};

/// What a render is asked from outside while it runs.
struct StopRequest {
  /// End with a whole image of the replicates that all pixels have. Two of them, for an error bar, or else
  /// one are waited for, if that takes no more than about 10 s; without one it is a fragment.
  std::atomic<bool> soon{false};
  std::atomic<bool> now{false};  ///< End, with a fragment if need be.
};

struct RenderProgress {
  double fraction = 0;                      ///< Done, in [0, 1].
  std::optional<double> seconds_to_finish;  ///< Where a stop waits for a pass: about how long.
};

/// Called from one thread at a time, after each tile.
using ProgressCallback = std::function<void(const RenderProgress&)>;

/// Threads that a render takes where none are asked for: those that this process may run on.
int available_threads();

/// Renders in passes over the whole image. Throws InputError where the settings do not fit the scene.
RenderResult render(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress = {},
                    const StopRequest* stop = nullptr);

}  // namespace etendue

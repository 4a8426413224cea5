// Scene -> Film: the tile loop, its settings, its progress, what it counted.
#pragma once

#include "film/film.h"
#include "integrator/block_counts.h"
#include "integrator/integrator.h"
#include "render/isa.h"
#include "scene/scene.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// How to render; what is not given comes from the scene file.
struct RenderSettings {
  IntegratorSettings integrator;
  int samples_per_pixel = 16;  ///< In all, over all replicates.
  int replicates = 4;          ///< Must divide samples_per_pixel.
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0: all that the process may use.
  Isa isa = Isa::scalar;
  bool is_reordering = true;  ///< Aim shadow packets; off only to show that it changes nothing.
};

/// A sample whose radiance was NaN, infinite or negative; it counts as zero in its pixel.
struct InvalidSample {
  int x, y;
  std::int64_t replicate, index;
  Colorf radiance;
};

inline constexpr std::size_t most_invalid_noted = 16;

struct RenderCounts : BlockCounts {
  std::int64_t samples = 0, invalid_samples = 0;

  /// The mean fraction of the lanes of a packet that hold a living path.
  double lane_occupancy() const { return lanes > 0 ? double(paths) / double(lanes) : 0; }
};

struct RenderResult {
  Film film;
  RenderCounts counts;
  std::vector<InvalidSample> invalid;  ///< Some of them, at most `most_invalid_noted`, in pixel order.
  double seconds = 0;
  bool is_interrupted = false;  ///< `stop` was set: pixels with count 0 were not rendered.
};

/// Called from one thread at a time with the fraction done in [0, 1], after each tile.
using ProgressCallback = std::function<void(double fraction)>;

/// Threads that a render takes where none are asked for: those that this process may run on.
int available_threads();

/// Throws InputError where the settings do not fit the scene.
RenderResult render(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress = {},
                    const std::atomic<bool>* stop = nullptr);

}  // namespace etendue

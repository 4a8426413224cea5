// The door between the program and a kernel module: one table per instruction set.
#pragma once

#include "integrator/sample_block.h"
#include "lightsampler/light_sampler.h"
#include "render/invalid_samples.h"
#include "render/render.h"
#include "render/work_unit.h"
#include "stats/largest_values.h"

#include <functional>
#include <span>
#include <vector>

namespace etendue {

/// A unit of work for one thread, and where its results go.
struct TileJob {
  const Scene* scene;
  const LightSampler* light_sampler;       ///< Over the scene's lights, as the settings name it.
  const RenderSettings* settings;          ///< Of which only the unit says how many samples there are.
  std::span<const LayerSet> layer_sets{};  ///< Those of the settings' layers, and then that of noise parts.
  WorkUnit unit;
  SampleBlock* block;  ///< Scratch of this thread.
  /// Out: for the image, and then for each layer of the sets: of each replicate of each pixel (row by row),
  /// the mean radiance.
  std::vector<Color<double>>* means;
  InvalidSamples* invalid;
  std::span<LargestValues> largest{};  ///< Of the last so many layers: get their samples.
  /// Asked between blocks, where set: ends the job before it is done.
  const std::function<bool()>* must_stop = nullptr;
  bool is_stopped = false;  ///< It was; `means` is not complete.
  /// Called after each block with what its samples have become, where set.
  const std::function<void(const SampleBlock&)>* on_block = nullptr;
};

/// What a module exports, through the C function `etendue_kernel`.
struct Kernel {
  int lanes;
  void (*render_tile)(TileJob&);
};

/// Loads the module once. Throws InputError where it is missing.
const Kernel& kernel_for(Isa isa);

}  // namespace etendue

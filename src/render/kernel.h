// The door between the program and a kernel module: one table per instruction set.
#pragma once

#include "film/film.h"
#include "integrator/integrator.h"
#include "integrator/sample_block.h"
#include "lightsampler/light_sampler.h"
#include "render/render.h"

#include <functional>
#include <vector>

namespace etendue {

/// A rectangle of pixels to render, upper bounds exclusive, and where its results go.
struct TileJob {
  const Scene* scene;
  const LightSampler* light_sampler;  ///< Over the scene's lights, as the settings name it.
  const RenderSettings* settings;
  int x_begin, y_begin, x_end, y_end;
  SampleBlock* block;  ///< Scratch of this thread.
  Film* film;
  std::vector<InvalidSample>* invalid;
  const std::atomic<bool>* stop = nullptr;        ///< Asked between blocks.
  std::int64_t samples = 0, invalid_samples = 0;  ///< `samples`: of pixels that are whole.
  bool is_stopped = false;                        ///< Some pixels of the tile were not rendered.
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

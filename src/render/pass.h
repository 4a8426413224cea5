// A pass: some replicates of every pixel, tile by tile, on all threads.
#pragma once

#include "film/film_stack.h"
#include "render/kernel.h"
#include "render/render.h"

#include <memory>

namespace etendue {

/// What a pass has done beside the film; nothing where it was given up.
struct PassResult {
  RenderCounts counts{};
  InvalidSamples invalid{};
  std::vector<double> covariances{};     ///< Of PartCovariances: the image, and each noise part.
  std::vector<LargestValues> largest{};  ///< Of each noise part's samples.
  double seconds = 0;
  bool is_complete = false;
};

/// The passes of a render, one after the other, on the same threads and buffers.
class Passes {
 public:
  /// All must outlive it.
  Passes(const Scene& scene, const RenderSettings& settings, const ProgressCallback& progress,
         const StopRequest* stop);
  ~Passes();
  Passes(const Passes&) = delete;
  Passes& operator=(const Passes&) = delete;

  /// About how long all threads take for a replicate of every pixel, in seconds: from some pixels here and
  /// there.
  double measure_pace();

  /// Renders [films.front().last(), end) of all films, that of the image and of each layer, and commits it.
  /// Where a stop ends the first pass of a film early, the tiles that are whole are committed; of later
  /// passes nothing is. A stop soon lets a pass that starts with fewer than two replicates come to its end,
  /// if that is no more than about 10 s after it.
  /// \param luminances get those of the image too, or of its first layer, where set
  PassResult render(std::vector<FilmStack>& films, int end, ReplicateLuminances* luminances = nullptr);

  /// All that is committed of a stack.
  Film take_film(FilmStack&& stack);

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

/// Where the pass after `done` of `replicates` ends, so that it takes about a second (longer where the image
/// is so large that adding a pass to the film takes time) and few films are kept: at a multiple of a power of
/// two. \param seconds_per_replicate as measured; `done` > 0
int end_of_next_pass(int done, int replicates, double seconds_per_replicate, double pixels);

}  // namespace etendue

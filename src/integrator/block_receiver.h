// The vertices of a block as lights see them.
#pragma once

#include "integrator/sample_block.h"
#include "integrator/vertex.h"

namespace etendue {

/// Of the paths i, i + 1 ... \param vertex_number the first sees the cut of the light tree of its tile
template <class F>
Receiver<F> receiver_at(const Scene& scene, const SampleBlock& block, int i, const Vertex<F>& vertex,
                        int vertex_number) {
  Receiver<F> receiver = vertex.receiver(scene);
  if (vertex_number == 0 && block.has_cuts) {
    receiver.cuts = &block.cuts;
    receiver.cut = load_lanes<Int<F>>(&block.cut[i]);
  }
  return receiver;
}

}  // namespace etendue

// The integrator that the settings name, over one block.
#pragma once

#include "integrator/average.h"
#include "integrator/direct.h"
#include "integrator/integrator.h"
#include "integrator/light.h"
#include "integrator/mis.h"

namespace etendue {

template <class F>
void run_integrator(const IntegratorSettings& settings, const Scene& scene, SampleBlock& block,
                    bool is_reordering) {
  switch (settings.kind) {
    case IntegratorKind::light:
      return light<F>(scene, block, is_reordering);
    case IntegratorKind::direct:
      return direct<F>(scene, block);
    case IntegratorKind::average:
      return average<F>(scene, block, is_reordering);
    case IntegratorKind::mis:
      return mis<F>(scene, block, settings.heuristic, is_reordering);
  }
}

}  // namespace etendue

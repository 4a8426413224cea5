// The integrator that the settings name, over one block.
#pragma once

#include "integrator/integrator.h"
#include "integrator/path.h"

namespace etendue {

template <class F>
void run_integrator(const IntegratorSettings& settings, const Scene& scene, SampleBlock& block,
                    bool is_reordering) {
  switch (settings.kind) {
    case IntegratorKind::path:
      if (settings.rules.bsdf_samples > 1)
        return direct_light_by_several<F>(scene, block, settings.rules, is_reordering);
      return path<F>(scene, block, settings.rules, is_reordering);
  }
}

}  // namespace etendue

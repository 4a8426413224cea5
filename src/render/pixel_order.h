// In which order the pixels of a unit of work are rendered.
#pragma once

#include "render/work_unit.h"

#include <vector>

namespace etendue {

struct PixelToRender {
  int x, y, samples_per_replicate;
};

/// Those with as many samples follow one another, in Morton order, so that a block of them is compact.
std::vector<PixelToRender> pixels_in_order(const WorkUnit& unit);

}  // namespace etendue

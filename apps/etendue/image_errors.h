// What is known of the error of an image: of each pixel, of the whole, of regions.
#pragma once

#include "film/convergence.h"
#include "film/pixel_intervals.h"
#include "film/region_mean.h"
#include "region.h"
#include "render/render.h"

#include <string>
#include <vector>

namespace etendue::app {

struct RegionErrors {
  std::string name;
  RegionMean mean;
  ConvergenceChecks checks;
};

struct ImageErrors {
  std::vector<PixelInterval> intervals;  ///< Of all pixels, rows from the top.
  std::vector<RegionErrors> regions;     ///< The whole, named "image", and those asked for.
};

ImageErrors errors_of(const RenderResult& result, const RenderSettings& settings,
                      const std::vector<ImageRegion>& regions, double confidence);

}  // namespace etendue::app

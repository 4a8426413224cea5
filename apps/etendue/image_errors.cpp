#include "image_errors.h"

namespace etendue::app {

ImageErrors errors_of(const RenderResult& result, const RenderSettings& settings,
                      const std::vector<ImageRegion>& regions, double confidence) {
  const Film& film = result.film;
  ImageErrors errors{pixel_intervals(film, result.luminances, confidence, settings.allocation_or_null()), {}};
  const auto add = [&](const ImageRegion& region) {
    errors.regions.push_back({region.name, region_mean(film, errors.intervals, region.pixels, confidence),
                              convergence_checks(film, result.luminances, region.pixels)});
  };
  add({"image", {0, 0, film.width(), film.height()}});
  for (const ImageRegion& region : regions) add(region);
  return errors;
}

}  // namespace etendue::app

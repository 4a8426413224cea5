#include "course/lab.h"

#include "course/lab_scene.h"
#include "render/image_layers.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace etendue {

namespace {

/// A layer for what each light brings that was scattered.
LayerSet layers_by_light(std::int32_t lights) {
  LayerSet set = scattered_light();
  set.light_parts = lights;
  for (std::int32_t light = 0; light < lights; ++light) set.light_part.push_back(light);
  return set;
}

/// Grey, as lights and plates all but are: it takes half the room of colours.
Image picture_of(const Film& film) {
  std::vector<float> values;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) values.push_back(float(luminance(film.at(x, y).mean)));
  return {film.width(), film.height(), {{"R", values}, {"G", values}, {"B", values}}, {}};
}

struct MeanAndVariance {
  double mean, variance;  ///< Of one sample, averaged over pixels.
};

/// Of a film whose replicates are single samples.
MeanAndVariance of_pixels(const Film& film, const std::vector<int>& pixels) {
  MeanAndVariance sum{0, 0};
  for (const int pixel : pixels) {
    const PixelStatistics& statistics = film.at(pixel % film.width(), pixel / film.width());
    sum.mean += statistics.mean.g;
    sum.variance += statistics.m2.g / double(statistics.count - 1);
  }
  const auto count = double(std::max<std::size_t>(pixels.size(), 1));
  return {sum.mean / count, sum.variance / count};
}

std::vector<std::vector<int>> pixels_of_plates(const Scene& scene, const std::vector<std::int32_t>& plates) {
  std::vector<std::vector<int>> pixels(plates.size());
  const std::vector<FirstHit> hits = first_hits(scene);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto plate = std::find(plates.begin(), plates.end(), hits[i].shape);
    if (plate != plates.end()) pixels[std::size_t(plate - plates.begin())].push_back(int(i));
  }
  return pixels;
}

/// The films of each method with the most samples, one after the other; the mean is that of the last one,
/// which knows it best.
std::vector<LabNoise> noise_of(const std::vector<std::vector<Film>>& layers,
                               const std::vector<std::vector<int>>& plates) {
  std::vector<LabNoise> noise;
  for (const std::vector<Film>& by_light : layers) {
    LabNoise& one = noise.emplace_back();
    for (const std::vector<int>& pixels : plates) {
      std::vector<double>& row = one.relative.emplace_back();
      for (std::size_t light = 0; light < by_light.size(); ++light) {
        const MeanAndVariance found = of_pixels(by_light[light], pixels);
        const double mean = of_pixels(layers.back()[light], pixels).mean;
        // Where the mean is not found, what makes it is too rare to have been met, and so is the noise.
        const bool is_known = std::abs(found.mean - mean) < 0.25 * mean;
        row.push_back(is_known ? std::sqrt(found.variance) / mean : std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
  return noise;
}

}  // namespace

LabGrid lab_grid(bool is_quick) {
  if (is_quick) return {{0.125, 1}, {0.5, 1}, {1, 16}, 48, 32};
  return {{1.0 / 32, 1.0 / 8, 1, 8}, {0.5, 1, 1.5}, {1, 4, 16, 64}, 240, 160};
}

std::optional<Lab> render_lab(const std::filesystem::path& scene, const LabGrid& grid, int threads, Isa isa,
                              const std::function<void(double)>& progress, const StopRequest& stop) {
  const SceneDesc description = read_nori_xml(scene);
  const std::vector<std::int32_t> plates = plate_shapes(description);
  const double all =
      double(grid.exponent_factors.size() * grid.size_factors.size() * std::size(lab_methods)) *
      std::accumulate(grid.samples.begin(), grid.samples.end(), 0.0);
  double done = 0;
  Lab lab;
  for (const double exponent_factor : grid.exponent_factors)
    for (const double size_factor : grid.size_factors) {
      const LoadedScene loaded =
          load_scene(changed_plates(description, {exponent_factor, size_factor, grid.width, grid.height}));
      RenderSettings settings;
      settings.threads = threads;
      settings.isa = isa;
      std::vector<std::vector<Film>> layers;
      for (const int samples : grid.samples)
        for (const std::string_view method : lab_methods) {
          settings.integrator = integrator_from_name(method);
          settings.samples_per_pixel = samples;
          settings.layers.clear();
          settings.replicates.reset();
          const bool is_measured = samples == grid.samples.back();
          if (is_measured) {
            settings.layers = {layers_by_light(loaded.scene.lights.count())};
            settings.replicates = samples;
          }
          ++settings.seed;
          RenderResult result = render(
              loaded.scene, settings,
              [&](const RenderProgress& now) { progress((done + now.fraction * samples) / all); }, &stop);
          if (stop.soon) return std::nullopt;
          done += samples;
          lab.pictures.push_back(picture_of(result.film));
          if (is_measured) layers.push_back(std::move(result.layers));
        }
      std::ranges::move(noise_of(layers, pixels_of_plates(loaded.scene, plates)),
                        std::back_inserter(lab.noise));
    }
  return lab;
}

}  // namespace etendue

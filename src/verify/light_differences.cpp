#include "verify/light_differences.h"

#include "render/image_layers.h"
#include "stats/mean_moments.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace etendue {
namespace {

constexpr std::size_t most_lights = 8;  // Each layer is a film.

std::vector<std::int32_t> lights_by_power(const Lights& lights) {
  std::vector<std::int32_t> all(std::size_t(lights.count()));
  std::iota(all.begin(), all.end(), 0);
  std::stable_sort(all.begin(), all.end(),
                   [&](std::int32_t a, std::int32_t b) { return lights.power(a) > lights.power(b); });
  all.resize(std::min(all.size(), most_lights));
  return all;
}

/// Luminance summed over a film. What channels share of their noise is not known: the bound is taken where
/// they go together.
MeanMoments sum_of_pixels(const Film& film) {
  MeanMoments sum;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      const double n = double(pixel.count);
      const auto root = [](double value) { return std::sqrt(value); };
      const auto cube_root = [](double value) { return std::cbrt(value); };
      const double error = luminance(Color<double>{root(pixel.m2.r), root(pixel.m2.g), root(pixel.m2.b)}),
                   skew = luminance(
                       Color<double>{cube_root(pixel.m3.r), cube_root(pixel.m3.g), cube_root(pixel.m3.b)});
      const double variance = error * error / (n * (n - 1));
      sum += {luminance(pixel.mean), variance, skew * skew * skew / (n * (n - 1) * (n - 2)),
              2 * variance * variance / (n - 1)};
    }
  return sum;
}

}  // namespace

std::vector<LightDifference> light_differences(const Scene& scene, RenderSettings a, RenderSettings b,
                                               double level, const StopRequest* stop) {
  const std::vector<std::int32_t> lights = lights_by_power(scene.lights);
  LayerSet by_light = scattered_light();
  by_light.light_parts = std::int32_t(lights.size());
  for (std::int32_t light = 0; light < scene.lights.count(); ++light) {
    const auto place = std::ranges::find(lights, light);
    by_light.light_part.push_back(place == lights.end() ? LayerSet::none
                                                        : std::int32_t(place - lights.begin()));
  }
  for (RenderSettings* const settings : {&a, &b}) {
    settings->layers = {by_light};
    settings->keeps_luminances_of_layer = false;
  }
  const RenderResult of_a = render(scene, a, {}, stop), of_b = render(scene, b, {}, stop);
  std::vector<LightDifference> differences;
  if (of_a.is_interrupted || of_b.is_interrupted) return differences;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const MeanMoments sum_a = sum_of_pixels(of_a.layers[k]), sum_b = sum_of_pixels(of_b.layers[k]);
    const double p = test_same_mean(sum_a, sum_b).p_value * double(lights.size());
    if (p < level) differences.push_back({lights[k], sum_a.mean / sum_b.mean, p});
  }
  std::stable_sort(differences.begin(), differences.end(),
                   [](const auto& x, const auto& y) { return x.p_value < y.p_value; });
  return differences;
}

}  // namespace etendue

#include "noritest/scene_luminance.h"

#include "base/hash.h"
#include "noritest/case_runner.h"
#include "render/kernel.h"

#include <algorithm>
#include <memory>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace etendue {
namespace {

/// Samples that one task renders: enough to outweigh its start, few enough to keep several threads busy.
constexpr std::int64_t samples_a_task = 8192;

/// A single pixel that is as large as the film.
void cover_film_by_one_pixel(Scene& scene, SamplerKind sampler) {
  Camera& camera = scene.camera;
  camera.per_px_x = camera.per_px_x * float(camera.width_px);
  camera.per_px_y = camera.per_px_y * float(camera.height_px);
  camera.width_px = camera.height_px = 1;
  scene.filter = PixelFilter::box();
  scene.lamp_outlines = LampOutlines(camera, scene.filter, scene.geometry, scene.lights);
  scene.sampler = sampler;
}

SceneLuminance render_task(const Scene& scene, const LightSampler& light_sampler,
                           const RenderSettings& settings, int samples, const Kernel& kernel,
                           SampleBlock& block) {
  SceneLuminance luminances;
  const std::function<void(const SampleBlock&)> add_samples = [&](const SampleBlock& rendered) {
    for (std::size_t i = 0; i < std::size_t(rendered.count); ++i)
      luminances.samples.add(
          luminance(Colorf{rendered.radiance.r[i], rendered.radiance.g[i], rendered.radiance.b[i]}));
  };
  std::vector<Color<double>> means;
  InvalidSamples invalid;
  TileJob job{.scene = &scene,
              .light_sampler = &light_sampler,
              .settings = &settings,
              .unit = {.pixels = {0, 0, 1, 1}, .samples_per_replicate = samples},
              .block = &block,
              .means = &means,
              .invalid = &invalid,
              .on_block = &add_samples};
  kernel.render_tile(job);
  luminances.invalid_samples = invalid.count();
  return luminances;
}

}  // namespace

SceneLuminance sample_luminance(Scene& scene, const IntegratorSettings& integrator, std::int64_t count,
                                const TestSettings& test, std::uint64_t seed) {
  cover_film_by_one_pixel(scene, test.sampler);
  const Kernel& kernel = kernel_for(test.isa);
  const IntegratorSettings settled_integrator = settled(integrator, scene.lights);
  const LightSampler light_sampler = light_sampler_for(settled_integrator, scene.lights);
  std::vector<SceneLuminance> parts(std::size_t((count + samples_a_task - 1) / samples_a_task));
  tbb::enumerable_thread_specific<std::unique_ptr<SampleBlock>> blocks(
      [] { return std::make_unique<SampleBlock>(); });
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    throw_if_stopped(test);
    RenderSettings settings;
    settings.integrator = settled_integrator;
    settings.seed = hash64(hash64(seed) + part);
    settings.isa = test.isa;
    const int samples = int(std::min(samples_a_task, count - std::int64_t(part) * samples_a_task));
    parts[part] = render_task(scene, light_sampler, settings, samples, kernel, *blocks.local());
  });
  SceneLuminance all;
  for (const SceneLuminance& part : parts) {
    all.samples = combine(all.samples, part.samples);
    all.invalid_samples += part.invalid_samples;
  }
  return all;
}

}  // namespace etendue

#include "render_report.h"

#include "messages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

namespace etendue::app {

namespace {

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t(usage.ru_maxrss) * 1024;
}

}  // namespace

std::int64_t Rendering::pixels_rendered() const {
  std::int64_t count = 0;
  for (int y = 0; y < result.film.height(); ++y)
    for (int x = 0; x < result.film.width(); ++x) count += result.film.at(x, y).count > 0;
  return count;
}

nlohmann::ordered_json stats(const Rendering& rendering) {
  const RenderSettings& settings = rendering.settings;
  const LoadedScene& loaded = rendering.loaded;
  const RenderResult& result = rendering.result;
  const Color<double> mean = result.film.mean();
  nlohmann::ordered_json json;
  json["scene"] = rendering.options.scene_file;
  json["scene_hash"] = fmt::format("{:016x}", rendering.scene_hash);
  json["dialect"] = dialect_name(rendering.description.dialect);
  json["dialect_reason"] = rendering.description.dialect_reason;
  json["integrator"] = settings.integrator.name;
  if (const std::string_view heuristic = heuristic_name(settings.integrator); !heuristic.empty())
    json["heuristic"] = heuristic;
  json["light_sampler"] = settings.integrator.light_sampler();
  json["sampler"] = sampler_name(loaded.scene.sampler);
  json["spp"] = rendering.samples_per_pixel();
  json["replicates"] = result.replicates;
  json["replicates_by"] = replicates_by_name(settings.replicates_by);
  json["seed"] = settings.seed;
  json["threads"] = settings.threads > 0 ? settings.threads : available_threads();
  json["isa"] = isa_name(settings.isa);
  json["width"] = result.film.width();
  json["height"] = result.film.height();
  json["seconds_load"] = loaded.seconds_read;
  json["seconds_build"] = loaded.seconds_build;
  json["seconds_render"] = result.seconds;
  json["interrupted"] = result.is_interrupted;
  json["pixels_not_rendered"] = rendering.pixels() - rendering.pixels_rendered();
  json["samples"] = result.counts.samples;
  json["samples_per_second"] = double(result.counts.samples) / result.seconds;
  json["camera_rays"] = result.counts.camera_rays;
  json["shadow_rays"] = result.counts.shadow_rays;
  json["bsdf_rays"] = result.counts.bsdf_rays;
  json["lane_occupancy"] = result.counts.lane_occupancy();
  json["invalid_samples"] = result.invalid.count();
  json["mean"] = {mean.r, mean.g, mean.b};
  json["mean_luminance"] = luminance(mean);
  json["triangles"] = loaded.scene.geometry.triangle_count();
  json["lights"] = loaded.scene.lights.count();
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

void warn(const RenderOptions& options, const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  if (options.is_strict)
    throw InputError(fmt::format("{}\n--strict makes warnings errors", fmt::join(warnings, "\n")));
  if (options.is_quiet) return;
  for (const std::string& warning : warnings) say("warning: {}\n", warning);
}

void report_invalid(const Rendering& rendering) {
  const RenderResult& result = rendering.result;
  if (result.invalid.count() == 0) return;
  say("warning: {} of {} samples were not finite, or were negative; each counts as 0 in its pixel\n",
      result.invalid.count(), result.counts.samples);
  for (const InvalidSample& sample : result.invalid.first())
    say("  pixel {},{} replicate {} sample {}: radiance {} {} {}\n", sample.x, sample.y, sample.replicate,
        sample.index, sample.radiance.r, sample.radiance.g, sample.radiance.b);
  say("to see how the first of them came about (by the scalar kernel, which may round another way):\n  {}\n",
      replay_command(rendering.options, result.invalid.first().front()));
}

}  // namespace etendue::app

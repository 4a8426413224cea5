#include "render/replay.h"

#include "integrator/run_integrator.h"

#include <fmt/format.h>
#include <limits>
#include <memory>

namespace etendue {

namespace {

using F = float;

void check(const Scene& scene, const RenderSettings& settings, const SampleId& sample) {
  const auto in_range = [](const char* what, std::int64_t value, std::int64_t count) {
    if (value < 0 || value >= count)
      throw InputError(fmt::format("replay: there is no {} {}; expected 0 to {}", what, value, count - 1));
  };
  in_range("pixel column", sample.x, scene.camera.width_px);
  in_range("pixel row", sample.y, scene.camera.height_px);
  in_range("replicate", sample.replicate, settings.replicates);
  in_range("sample", sample.index, settings.samples_per_pixel / settings.replicates);
}

/// A block of this one sample.
std::unique_ptr<SampleBlock> block_of(const RenderSettings& settings, const SampleId& sample) {
  auto block = std::make_unique<SampleBlock>();
  const std::uint64_t stream = sample_stream(settings.seed, sample.x, sample.y, sample.replicate);
  block->count = block->padded_count = 1;
  block->pixel_x[0] = sample.x;
  block->pixel_y[0] = sample.y;
  block->stream_lo[0] = std::uint32_t(stream);
  block->stream_hi[0] = std::uint32_t(stream >> 32);
  block->index[0] = std::uint32_t(sample.index);
  return block;
}

/// The stages that every integrator starts with.
void trace_camera_ray(const Scene& scene, SampleBlock& block, SampleTrace& trace) {
  camera_rays<F>(scene, block);
  const Vec2<F> u_film = to_unit_floats<F>(sample_bits<F>(scene, block, 0, dimension::film));
  trace.x_px = float(block.pixel_x[0]) + 0.5f + scene.filter.sample_offset_px(u_film.x);
  trace.y_px = float(block.pixel_y[0]) + 0.5f + scene.filter.sample_offset_px(u_film.y);
  trace.ray_origin = load_lanes<F>(block.camera_ray.origin, 0);
  trace.ray_direction = load_lanes<F>(block.camera_ray.direction, 0);
  closest_hits<F>(scene, block);
  const SurfacePoint<F> surface(scene, block.camera_ray, block.camera_hit, 0);
  if (surface.is_there) {
    const std::int32_t geometry = block.camera_hit.geometry[0];
    trace.hit = {surface.position,
                 surface.ng,
                 surface.ns,
                 geometry,
                 block.camera_hit.primitive[0],
                 surface.material,
                 scene.geometry.light[std::size_t(geometry)]};
  }
  add_emission<F>(scene, block);
  trace.emission = load_lanes<F>(block.radiance, 0);
}

SampleTrace::LightSample light_sample_of(const Scene& scene, const SampleBlock& block) {
  const SurfacePoint<F> surface(scene, block.camera_ray, block.camera_hit, 0);
  const LightSample<F> sample =
      sample_lights<F>(scene, surface.position, sample_bits<F>(scene, block, 0, dimension::light), true);
  return {sample.light,
          sample.end,
          sample.radiance_over_pdf,
          sample.pdf_solid_angle(),
          load_lanes<F>(block.unshadowed, 0),
          block.shadow_is_needed[0] != 0,
          block.shadow_is_free[0] != 0};
}

SampleTrace::BsdfSample bsdf_sample_of(const Scene& scene, const SampleBlock& block) {
  const bool is_ray_cast = block.bsdf_ray.is_active[0] != 0;
  const bool is_hit = is_ray_cast && block.bsdf_hit.geometry[0] >= 0;
  return {is_ray_cast,
          load_lanes<F>(block.bsdf_ray.direction, 0),
          load_lanes<F>(block.throughput, 0),
          block.pdf_bsdf[0],
          is_hit ? block.bsdf_hit.t[0] : std::numeric_limits<float>::infinity(),
          is_hit ? scene.geometry.light[std::size_t(block.bsdf_hit.geometry[0])] : -1};
}

}  // namespace

SampleTrace replay(const Scene& scene, const RenderSettings& settings, const SampleId& sample) {
  check(scene, settings, sample);
  SampleTrace trace{};
  trace_camera_ray(scene, *block_of(settings, sample), trace);
  const std::unique_ptr<SampleBlock> block = block_of(settings, sample);
  run_integrator<F>(settings.integrator, scene, *block, false);
  const IntegratorKind kind = settings.integrator.kind;
  if (trace.hit && kind != IntegratorKind::direct) trace.light_sample = light_sample_of(scene, *block);
  if (trace.hit && kind != IntegratorKind::light) trace.bsdf_sample = bsdf_sample_of(scene, *block);
  trace.radiance = load_lanes<F>(block->radiance, 0);
  return trace;
}

}  // namespace etendue

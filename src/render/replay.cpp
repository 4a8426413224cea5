#include "render/replay.h"

#include "integrator/run_integrator.h"
#include "integrator/single_sample.h"

#include <fmt/format.h>
#include <memory>
#include <utility>

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
  in_range("replicate", sample.replicate, settings.replicate_count());
  in_range("sample", sample.index, settings.samples_per_replicate_of(sample.x, sample.y));
}

/// A block of this one sample.
std::unique_ptr<SampleBlock> block_of(const RenderSettings& settings, const SampleId& sample) {
  auto block = std::make_unique<SampleBlock>();
  const ReplicatePlace place =
      replicate_place(settings.replicates_by, settings.seed, sample.x, sample.y, sample.replicate,
                      settings.samples_per_replicate_of(sample.x, sample.y));
  block->count = block->padded_count = 1;
  block->pixel_x[0] = sample.x;
  block->pixel_y[0] = sample.y;
  block->path.stream_lo[0] = std::uint32_t(place.stream);
  block->path.stream_hi[0] = std::uint32_t(place.stream >> 32);
  block->path.index[0] = place.first_index + std::uint32_t(sample.index);
  return block;
}

/// What the light sample was that the block has just cast the shadow ray of.
SampleTrace::LightSample trace_of(const Scene& scene, const LightSampler& light_sampler,
                                  const PathRules& rules, const SampleBlock& block,
                                  const LightSampleNumber& which, int k) {
  const PathColumns& path = block.path;
  const Vertex<F> vertex(scene, load_ray<F>(path.ray, 0), load_hit<F>(path.hit, 0));
  const DirectLightSample<F> sample = light_sample_of<F>(
      scene, light_sampler, rules, block, 0, vertex, receiver_at<F>(scene, block, 0, vertex, which.vertex),
      candidates_of<F>(scene, rules, which.vertex, vertex), which);
  const int row = block.shadow.row(k, 0);
  SampleTrace::LightSample trace{sample.light.light,
                                 sample.light.end,
                                 sample.light.radiance_over_pdf,
                                 sample.light.pdf_solid_angle,
                                 load_lanes<F>(block.shadow.unshadowed, row),
                                 block.shadow.is_needed[row] != 0,
                                 false,
                                 {}};
  if (!trace.is_shadow_ray_cast) return trace;
  trace.is_visible = is_visible(scene, sample.origin, sample.light.end);
  if (!trace.is_visible) {
    const Hit<F> hit = closest_hit(scene, {sample.origin, sample.along}, 0, shadow_segment_end);
    trace.hidden_by = {hit.geometry, hit.primitive};
  }
  return trace;
}

SampleTrace::Vertex vertex_of(const Scene& scene, const PathRules& rules, const SampleBlock& block,
                              int number, int branch) {
  const PathColumns& path = block.path;
  const Hit<F> hit = load_hit<F>(path.hit, 0);
  const Vertex<F> vertex(scene, load_ray<F>(path.ray, 0), hit);
  SampleTrace::Vertex trace{number, branch, SampleTrace::Vertex::Kind::nothing, vertex.position, {},
                            {},     {},     load_lanes<F>(block.radiance, 0)};
  if (!vertex.is_there) return trace;
  trace.kind = vertex.is_surface ? SampleTrace::Vertex::Kind::surface : SampleTrace::Vertex::Kind::medium;
  if (vertex.is_surface)
    trace.surface = {vertex.ng,     vertex.ns,       hit.geometry,
                     hit.primitive, vertex.material, scene.geometry.light[std::size_t(hit.geometry)]};
  if (rules.bsdf_samples(number) > 0)
    trace.bsdf_sample = {block.next_ray.is_active[0] != 0, load_lanes<F>(block.next_ray.direction, 0),
                         load_lanes<F>(path.throughput, 0), path.pdf[0]};
  return trace;
}

}  // namespace

SampleTrace replay(const Scene& scene, const RenderSettings& settings, const SampleId& sample) {
  check(scene, settings, sample);
  const IntegratorSettings integrator = settled(settings.integrator, scene.lights);
  SampleTrace trace{};
  const std::unique_ptr<SampleBlock> block = block_of(settings, sample);
  camera_rays<F>(scene, *block);
  const Vec2<F> u_film = to_unit_floats<F>(sample_bits<F>(scene, block->path, 0, dimension::film));
  trace.x_px = float(sample.x) + 0.5f + scene.filter.sample_offset_px(u_film.x);
  trace.y_px = float(sample.y) + 0.5f + scene.filter.sample_offset_px(u_film.y);
  trace.ray_origin = load_lanes<F>(block->path.ray.origin, 0);
  trace.ray_direction = load_lanes<F>(block->path.ray.direction, 0);
  const LightSampler light_sampler = light_sampler_for(integrator, scene.lights);
  const PathRules* rules = integrator.path_rules();
  std::optional<SampleTrace::LightSample> light_sample;
  const BlockWatcher watcher{
      .on_light_sample = [&](const SampleBlock& at, const LightSampleNumber& which,
                             int k) { light_sample = trace_of(scene, light_sampler, *rules, at, which, k); },
      .on_vertex =
          [&](const SampleBlock& at, int vertex, int branch) {
            trace.vertices.push_back(vertex_of(scene, *rules, at, vertex, branch));
            if (trace.vertices.back().kind != SampleTrace::Vertex::Kind::nothing)
              trace.vertices.back().light_sample = std::exchange(light_sample, std::nullopt);
          }};
  block->watcher = &watcher;
  run_integrator<F>(integrator, scene, light_sampler, *block, false);
  trace.radiance = load_lanes<F>(block->radiance, 0);
  return trace;
}

}  // namespace etendue

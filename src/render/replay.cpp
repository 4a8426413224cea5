#include "render/replay.h"

#include "integrator/run_integrator.h"

#include <fmt/format.h>
#include <functional>
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
  in_range("replicate", sample.replicate, settings.replicate_count());
  in_range("sample", sample.index, settings.samples_per_pixel / settings.replicate_count());
}

/// A block of this one sample.
std::unique_ptr<SampleBlock> block_of(const RenderSettings& settings, const SampleId& sample) {
  auto block = std::make_unique<SampleBlock>();
  const ReplicatePlace place = replicate_place(settings.replicates_by, settings.seed, sample.x, sample.y,
                                               sample.replicate, settings.samples_per_replicate());
  block->count = block->padded_count = 1;
  block->pixel_x[0] = sample.x;
  block->pixel_y[0] = sample.y;
  block->path.stream_lo[0] = std::uint32_t(place.stream);
  block->path.stream_hi[0] = std::uint32_t(place.stream >> 32);
  block->path.index[0] = place.first_index + std::uint32_t(sample.index);
  return block;
}

SampleTrace::Vertex vertex_of(const Scene& scene, const PathRules& rules, const SampleBlock& block,
                              int number, int branch) {
  const PathColumns& path = block.path;
  const Vertex<F> vertex(scene, path.ray, path.hit, 0);
  SampleTrace::Vertex trace{number, branch, SampleTrace::Vertex::Kind::nothing, vertex.position, {},
                            {},     {},     load_lanes<F>(block.radiance, 0)};
  if (!vertex.is_there) return trace;
  trace.kind = vertex.is_surface ? SampleTrace::Vertex::Kind::surface : SampleTrace::Vertex::Kind::medium;
  const std::int32_t geometry = path.hit.geometry[0];
  if (vertex.is_surface)
    trace.surface = {vertex.ng,       vertex.ns,
                     geometry,        path.hit.primitive[0],
                     vertex.material, scene.geometry.light[std::size_t(geometry)]};
  if (number == rules.most_vertices) return trace;
  if (rules.has_light_samples() && scene.lights.count() > 0) {
    const int last = (rules.is_every_light ? scene.lights.count() : rules.light_samples) - 1;
    const LightSample<F> sample = sample_lights<F>(scene, rules, path, vertex, 0, number, last);
    trace.light_sample = {sample.light,
                          sample.end,
                          sample.radiance_over_pdf,
                          sample.pdf_solid_angle(),
                          load_lanes<F>(block.unshadowed, 0),
                          block.shadow_is_needed[0] != 0,
                          block.shadow_is_free[0] != 0};
  }
  if (rules.is_followed(number))
    trace.bsdf_sample = {block.next_ray.is_active[0] != 0, load_lanes<F>(block.next_ray.direction, 0),
                         load_lanes<F>(path.throughput, 0), path.pdf[0]};
  return trace;
}

}  // namespace

SampleTrace replay(const Scene& scene, const RenderSettings& settings, const SampleId& sample) {
  check(scene, settings, sample);
  SampleTrace trace{};
  const std::unique_ptr<SampleBlock> block = block_of(settings, sample);
  camera_rays<F>(scene, *block);
  const Vec2<F> u_film = to_unit_floats<F>(sample_bits<F>(scene, block->path, 0, dimension::film));
  trace.x_px = float(sample.x) + 0.5f + scene.filter.sample_offset_px(u_film.x);
  trace.y_px = float(sample.y) + 0.5f + scene.filter.sample_offset_px(u_film.y);
  trace.ray_origin = load_lanes<F>(block->path.ray.origin, 0);
  trace.ray_direction = load_lanes<F>(block->path.ray.direction, 0);
  const std::function<void(const SampleBlock&, int, int)> note = [&](const SampleBlock& at, int number,
                                                                     int branch) {
    trace.vertices.push_back(vertex_of(scene, settings.integrator.rules, at, number, branch));
  };
  block->on_vertex = &note;
  run_integrator<F>(settings.integrator, scene, *block, false);
  trace.radiance = load_lanes<F>(block->radiance, 0);
  return trace;
}

}  // namespace etendue

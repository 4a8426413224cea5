// How near a render comes to the speed of its rays alone: see docs/performance.md for how to read it.
//
// Tiles spread over the image are rendered on one thread; the rays of each are then cast again, bare, in
// packets of the same width and in sample order. fraction_of_limit = bare time / render time.

#include "generated_scenes.h"
#include "integrator/vertex.h"
#include "render/kernel.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

namespace {

using namespace etendue;

constexpr int width_px = 768, height_px = 512, tile_px = 32;

/// Processor time of this thread: other programs on the machine do not count.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// The rays that arrive at one kind of vertices of a tile, and the shadow rays that leave there, in the order
/// of samples.
struct Recording {
  struct Vec3s {
    std::vector<float> x, y, z;
    template <int rows>
    void append(const Vec3ColumnOf<rows>& column, int first, int count) {
      x.insert(x.end(), column.x.begin() + first, column.x.begin() + first + count);
      y.insert(y.end(), column.y.begin() + first, column.y.begin() + first + count);
      z.insert(z.end(), column.z.begin() + first, column.z.begin() + first + count);
    }
    void clear() { x.clear(), y.clear(), z.clear(); }
  };
  Vec3s origin, direction, shadow_origin, shadow_direction;
  std::vector<float> t_near, t_far;
  std::vector<std::int32_t> is_active, shadow_order;
  std::int64_t rays = 0;

  /// Those of one light sample.
  void append_shadow_rays(const SampleBlock& block, int k) {
    const ShadowRays& shadow = block.shadow;
    for (int i = 0; i < shadow.stride; ++i) {
      const bool is_cast = shadow.is_needed[std::size_t(shadow.row(k, i))] && i < block.path.count;
      shadow_order.push_back(is_cast ? std::int32_t(shadow_origin.x.size()) + i : -1);
    }
    shadow_origin.append(shadow.origin, shadow.row(k, 0), shadow.stride);
    shadow_direction.append(shadow.along, shadow.row(k, 0), shadow.stride);
  }
  void append_rays(const SampleBlock& block) {
    const PathColumns& path = block.path;
    const int count = path.padded_count;
    rays += path.count;
    origin.append(path.ray.origin, 0, count);
    direction.append(path.ray.direction, 0, count);
    t_near.insert(t_near.end(), path.ray.t_near.begin(), path.ray.t_near.begin() + count);
    t_far.insert(t_far.end(), path.ray.t_far.begin(), path.ray.t_far.begin() + count);
    is_active.insert(is_active.end(), path.ray.is_active.begin(), path.ray.is_active.begin() + count);
  }
  void clear() {
    for (Vec3s* vectors : {&origin, &direction, &shadow_origin, &shadow_direction}) vectors->clear();
    for (std::vector<float>* values : {&t_near, &t_far}) values->clear();
    for (std::vector<std::int32_t>* values : {&is_active, &shadow_order}) values->clear();
  }

  /// Casts the rays that arrive; seconds.
  double cast_bare(const RayCaster& caster, int lanes, Coherence coherence) {
    const int count = int(t_near.size());
    hit_t_.resize(t_near.size());
    for (auto* values : {&ng_x_, &ng_y_, &ng_z_, &u_, &v_}) values->resize(t_near.size());
    for (auto* values : {&geometry_, &primitive_}) values->resize(t_near.size());
    const double start = thread_seconds();
    caster.closest_hits(
        {origin.x.data(), origin.y.data(), origin.z.data(), direction.x.data(), direction.y.data(),
         direction.z.data(), t_near.data(), t_far.data(), is_active.data(), count},
        {hit_t_.data(), ng_x_.data(), ng_y_.data(), ng_z_.data(), u_.data(), v_.data(), geometry_.data(),
         primitive_.data()},
        lanes, coherence);
    return thread_seconds() - start;
  }

  /// Casts the shadow rays; seconds.
  double cast_bare_shadows(const RayCaster& caster, int lanes) {
    is_free_.resize(shadow_order.size());
    const double start = thread_seconds();
    caster.unoccluded({shadow_origin.x.data(), shadow_origin.y.data(), shadow_origin.z.data(),
                       shadow_direction.x.data(), shadow_direction.y.data(), shadow_direction.z.data(),
                       shadow_order.data(), int(shadow_order.size()), shadow_segment_end},
                      is_free_.data(), lanes, Coherence::incoherent);
    return thread_seconds() - start;
  }

 private:
  std::vector<float> hit_t_, ng_x_, ng_y_, ng_z_, u_, v_;
  std::vector<std::int32_t> geometry_, primitive_, is_free_;
};

struct Measurement {
  double samples = 0, render_seconds = 0;
  double unaimed_seconds = 0;  ///< Of the render with its shadow rays in sample order.
  double camera_seconds = 0, bounce_seconds = 0, shadow_seconds = 0;  ///< Bare.
  std::int64_t bounce_rays = 0;
  double lane_occupancy = 0;
  std::map<std::string, double> stage_shares;

  double bare_seconds() const { return camera_seconds + bounce_seconds + shadow_seconds; }
};

Measurement measure(const Scene& scene, const IntegratorSettings& integrator, Isa isa, int samples_per_pixel,
                    double most_samples) {
  RenderSettings settings;
  settings.integrator = settled(integrator, scene.lights);
  settings.isa = isa;
  const Kernel& kernel = kernel_for(isa);
  const LightSampler light_sampler = light_sampler_for(integrator, scene.lights);
  const int replicates = default_replicates(samples_per_pixel);
  std::vector<Color<double>> means;
  InvalidSamples invalid;
  const auto block = std::make_unique<SampleBlock>();
  const auto recording_block = std::make_unique<SampleBlock>();
  const auto unaimed_block = std::make_unique<SampleBlock>();
  RenderSettings unaimed_settings = settings;
  unaimed_settings.is_reordering = false;
  Recording camera, bounces;
  const BlockWatcher record{
      .on_light_sample = [&](const SampleBlock& b, const LightSampleNumber& which,
                             int k) { (which.vertex == 0 ? camera : bounces).append_shadow_rays(b, k); },
      .on_vertex =
          [&](const SampleBlock& b, int vertex, int branch) {
            if (vertex == 0 && branch > 0) return;  // The same camera rays again.
            (vertex == 0 ? camera : bounces).append_rays(b);
          }};
  recording_block->watcher = &record;

  // Whole tiles only: what is left at the right and below counts for nothing here.
  const int columns = scene.camera.width_px / tile_px, tiles = columns * (scene.camera.height_px / tile_px);
  const double tile_samples = double(tile_px) * tile_px * samples_per_pixel;
  const int wanted = std::clamp(int(most_samples / tile_samples), 8, tiles);
  Measurement sum;
  for (int k = 0; k < wanted; ++k) {
    const int tile = int((std::int64_t(k) * tiles + tiles / 2) / wanted) % tiles;
    const int x = tile % columns * tile_px, y = tile / columns * tile_px;
    TileJob job{.scene = &scene,
                .light_sampler = &light_sampler,
                .settings = &settings,
                .unit = {.pixels = {x, y, x + tile_px, y + tile_px},
                         .replicates = replicates,
                         .samples_per_replicate = samples_per_pixel / replicates},
                .block = recording_block.get(),
                .means = &means,
                .invalid = &invalid};
    camera.clear();
    bounces.clear();
    kernel.render_tile(job);
    job.block = block.get();
    const double start = thread_seconds();
    kernel.render_tile(job);
    sum.render_seconds += thread_seconds() - start;
    job.settings = &unaimed_settings;
    job.block = unaimed_block.get();
    const double start_unaimed = thread_seconds();
    kernel.render_tile(job);
    sum.unaimed_seconds += thread_seconds() - start_unaimed;
    sum.camera_seconds += camera.cast_bare(scene.rays, kernel.lanes, Coherence::coherent);
    sum.bounce_seconds += bounces.cast_bare(scene.rays, kernel.lanes, Coherence::incoherent);
    sum.shadow_seconds += camera.cast_bare_shadows(scene.rays, kernel.lanes) +
                          bounces.cast_bare_shadows(scene.rays, kernel.lanes);
    sum.samples += tile_samples;
  }
  sum.bounce_rays = bounces.rays;
  sum.lane_occupancy = double(block->counts.paths) / double(block->counts.lanes);
  double staged = 0;
  for (const double seconds : block->clock.seconds()) staged += seconds;
  for (std::size_t s = 0; s < stage_names.size(); ++s)
    if (block->clock.seconds()[s] > 0) sum.stage_shares[stage_names[s]] = block->clock.seconds()[s] / staged;
  return sum;
}

/// Samples a second of a whole render.
double throughput(const Scene& scene, const IntegratorSettings& integrator, int threads,
                  int samples_per_pixel) {
  RenderSettings settings;
  settings.integrator = integrator;
  settings.samples_per_pixel = samples_per_pixel;
  settings.isa = available_isas().back();
  settings.threads = threads;
  const RenderResult result = render(scene, settings);
  return double(result.counts.samples) / result.seconds;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Fraction of the bare-ray limit that a render reaches, on generated scenes"};
  bool is_json = false, has_normals = false;
  double most_samples = 25e6;
  std::string integrator_name = "light";
  std::vector<std::string> isa_names, scene_files;
  std::vector<int> grids{65, 700}, sample_counts{64, 1024}, light_counts;
  app.add_flag("--json", is_json, "JSON on standard output");
  app.add_flag("--normals", has_normals, "Meshes with vertex normals");
  app.add_option("--integrator", integrator_name, "As of etendue render")->capture_default_str();
  app.add_option("--scene", scene_files, "Scene files of your own, instead of the generated ones");
  app.add_option("--lights", light_counts, "Numbers of lights: a swarm of them above the terrain instead")
      ->delimiter(',');
  app.add_option("--grids", grids, "Sizes of the scene: 2 grid^2 triangles and more")->delimiter(',');
  app.add_option("--spp", sample_counts, "Samples a pixel")->delimiter(',');
  app.add_option("--isa", isa_names, "Instruction sets; all that this machine has unless given")
      ->delimiter(',');
  app.add_option("--samples", most_samples, "Samples to render for each figure")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const IntegratorSettings integrator = integrator_from_name(integrator_name);
  std::vector<Isa> isas;
  for (const std::string& name : isa_names) isas.push_back(isa_from_name(name));
  if (isas.empty()) isas = available_isas();

  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::FILE* text = is_json ? stderr : stdout;
  const auto measure_scene = [&](const Scene& scene, const std::string& name) {
    fmt::print(text, "\n{}; one thread\n", name);
    for (const Isa isa : isas)
      for (const int samples_per_pixel : sample_counts) {
        const Measurement m = measure(scene, integrator, isa, samples_per_pixel,
                                      isa == Isa::scalar ? most_samples / 4 : most_samples);
        const double fraction = m.bare_seconds() / m.render_seconds;
        fmt::print(
            text,
            "  {:<6} {:>4} samples a pixel: {:6.2f} M samples/s, limit {:6.2f}, fraction_of_limit {:.3f}, "
            "{:.2f} x sample order\n",
            isa_name(isa), samples_per_pixel, 1e-6 * m.samples / m.render_seconds,
            1e-6 * m.samples / m.bare_seconds(), fraction, m.unaimed_seconds / m.render_seconds);
        if (m.bounce_rays > 0)
          fmt::print(text,
                     "         lane_occupancy {:.3f}; bare rays: camera {:.0f} %, bounces {:.0f} % ({:.2f} M "
                     "rays/s), "
                     "shadow {:.0f} %\n",
                     m.lane_occupancy, 100 * m.camera_seconds / m.bare_seconds(),
                     100 * m.bounce_seconds / m.bare_seconds(),
                     1e-6 * double(m.bounce_rays) / m.bounce_seconds,
                     100 * m.shadow_seconds / m.bare_seconds());
        nlohmann::ordered_json stages;
        fmt::print(text, "        ");
        for (const auto& [stage, share] : m.stage_shares) {
          stages[stage] = share;
          fmt::print(text, " {} {:.0f} %", stage, 100 * share);
        }
        fmt::print(text, "\n");
        json.push_back({{"scene", name},
                        {"integrator", integrator.name},
                        {"isa", isa_name(isa)},
                        {"spp", samples_per_pixel},
                        {"samples_per_second", m.samples / m.render_seconds},
                        {"limit_samples_per_second", m.samples / m.bare_seconds()},
                        {"fraction_of_limit", fraction},
                        {"speed_over_sample_order", m.unaimed_seconds / m.render_seconds},
                        {"lane_occupancy", m.lane_occupancy},
                        {"stages", stages}});
      }
    if (!isa_names.empty()) return;  // The speed-up belongs to the complete run.
    throughput(scene, integrator, 2, 16);
    double ratio = 0;
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round)
      ratio += throughput(scene, integrator, 2, 64) / throughput(scene, integrator, 1, 64) / rounds;
    fmt::print(text, "  2 threads over 1: {:.2f}\n", ratio);
    for (auto& row : json)
      if (row["scene"] == name) row["speed_up_2_threads"] = ratio;
  };
  for (const std::string& file : scene_files) measure_scene(load_scene(read_nori_xml(file)).scene, file);
  for (const int count : light_counts)
    measure_scene(bench::swarm_scene(count, width_px, height_px), fmt::format("swarm of {} lights", count));
  if (scene_files.empty() && light_counts.empty())
    for (const int grid : grids) {
      const Scene scene = bench::terrain_scene(grid, width_px, height_px, has_normals);
      measure_scene(scene, fmt::format("terrain, {} triangles{}", scene.geometry.triangle_count(),
                                       has_normals ? ", vertex normals" : ""));
    }
  if (is_json) fmt::print("{}\n", json.dump(2));
} catch (const std::exception& error) {
  fmt::print(stderr, "error: {}\n", error.what());
  return 2;
}

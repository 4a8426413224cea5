// How often the interval of a pixel holds its true value, by class of pixel and by the rule that made it.
// docs/error_bars.md has the figures.

#include "film/pixel_intervals.h"
#include "generated_scenes.h"
#include "integrator/single_sample.h"
#include "lint/probe.h"
#include "render/pilot.h"
#include "render/render.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "stats/running.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace etendue;

/// What a pixel is like; the later class holds where two do.
enum PixelClass { lit, penumbra, glossy, edge, rare_event, classes };
constexpr std::array<const char*, classes> class_names{"lit", "penumbra", "glossy", "edge", "rare event"};

struct Pixel {
  double truth = 0;
  double relative_error_sq = 0;  ///< Of one sample.
  double skewness = 0;           ///< Of one sample.
  bool is_edge = false;          ///< It sees surfaces of different normals.
  bool is_glossy = false;        ///< It sees a highlight: light that a diffuse surface would not send.

  bool is_noisy() const { return truth > 0 && relative_error_sq > 1e-8; }
  PixelClass class_at(int samples) const {
    // The mean of all samples has half the skewness of the exponential law, or more.
    if (skewness * skewness > samples) return rare_event;
    if (is_edge) return edge;
    if (is_glossy) return glossy;
    return relative_error_sq < 0.25 ? lit : penumbra;
  }
};

struct Setup {
  std::string integrator;
  int samples, replicates;
  ReplicatesBy by;
  std::uint64_t seed;
};

RenderSettings settings_of(const Setup& setup) {
  RenderSettings settings;
  settings.integrator = integrator_from_name(setup.integrator);
  settings.samples_per_pixel = setup.samples;
  settings.replicates = setup.replicates;
  settings.replicates_by = setup.by;
  settings.seed = setup.seed;
  settings.isa = available_isas().back();
  return settings;
}

RenderResult render_with(const Scene& scene, const Setup& setup) { return render(scene, settings_of(setup)); }

template <class Function>
void for_each_pixel(const Film& film, Function&& f) {
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) f(std::size_t(y * film.width() + x), x, y);
}

/// \param exact the value of every pixel, where it is known; else a reference is rendered
std::vector<Pixel> look_at(const Scene& scene, const std::string& integrator, int samples, double exact) {
  constexpr int samples_of_moments = 4096, samples_of_reference = 1000;
  std::vector<Pixel> pixels(std::size_t(scene.camera.width_px) * std::size_t(scene.camera.height_px));
  const std::vector<MaterialFacts> facts = facts_of(scene.materials);
  const Film single =
      render_with(scene, {integrator, samples_of_moments, samples_of_moments, ReplicatesBy::block, 99}).film;
  const Film normals = render_with(scene, {"normals", 64, 64, ReplicatesBy::block, 99}).film;
  const Film reference = exact > 0 ? Film(1, 1)
                                   : render_with(scene, {integrator, samples_of_reference * samples,
                                                         samples_of_reference, ReplicatesBy::block, 12345})
                                         .film;
  for_each_pixel(single, [&](std::size_t i, int x, int y) {
    const PixelStatistics& pixel = single.at(x, y);
    const RunningStatistics green{pixel.count, pixel.mean.g, pixel.m2.g, pixel.m3.g};
    pixels[i].relative_error_sq = green.variance() / (green.mean * green.mean);
    pixels[i].skewness = green.skewness();
    pixels[i].is_edge = normals.at(x, y).m2.g / 63 > 1e-4;
    pixels[i].truth = exact > 0 ? exact : luminance(reference.at(x, y).mean);
    const CameraRay<float> ray = scene.camera.ray(float(x) + 0.5f, float(y) + 0.5f);
    const auto hit = probe(scene, {ray.origin, ray.direction}, ray.t_near, ray.t_far);
    pixels[i].is_glossy = hit && !hit->vertex.leaves_direct_light_to_lights(scene);
  });
  return pixels;
}

/// Shares, one for each seed: seeds are independent, pixels of one image share a reference.
struct Coverage {
  RunningStatistics covered, trusted, covered_where_trusted;
};

/// Of a pixel over all seeds, where it was trusted.
struct Width {
  double error_sq = 0, half_width = 0, count = 0;
  double in_true_errors() const { return half_width / count / std::sqrt(error_sq / count); }
};

struct Count {
  double pixels = 0, covered = 0, trusted = 0, covered_where_trusted = 0;
};

std::string share_text(const RunningStatistics& shares) {
  if (shares.count < 2) return fmt::format("{:>13}", "-");
  const Interval interval = student_t_interval(shares, 0.95);
  return fmt::format("{:5.1f} +-{:4.1f} %", 100 * shares.mean, 50 * (interval.upper - interval.lower));
}

/// Over the pixels of a class.
double median_width(const std::vector<Pixel>& pixels, const std::vector<Width>& widths, PixelClass of_class,
                    int samples) {
  std::vector<double> of_pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (widths[i].count > 0 && pixels[i].class_at(samples) == of_class)
      of_pixels.push_back(widths[i].in_true_errors());
  if (of_pixels.empty()) return 0;
  const auto middle = of_pixels.begin() + std::ptrdiff_t(of_pixels.size() / 2);
  std::nth_element(of_pixels.begin(), middle, of_pixels.end());
  return *middle;
}

struct Runs {
  int samples, seeds;
  bool are_adaptive;
};

void measure(const Scene& scene, const std::string& integrator, const Runs& runs, double exact) {
  const auto& [samples, seeds, are_adaptive] = runs;
  const std::vector<Pixel> pixels = look_at(scene, integrator, samples, exact);
  for (const ReplicatesBy by : {ReplicatesBy::block, ReplicatesBy::scrambling})
    for (const int replicates : {4, 8, 16, 32}) {
      if (replicates > samples) continue;
      std::array<Coverage, classes> by_class{};
      std::array<Coverage, interval_rules> by_rule{};
      std::vector<Width> widths(pixels.size());
      for (int seed = 0; seed < seeds; ++seed) {
        RenderSettings settings = settings_of({integrator, samples, replicates, by, std::uint64_t(seed)});
        if (are_adaptive) settings.allocation = allocation_for(scene, settings).allocation;
        const RenderResult result = render(scene, settings);
        const std::vector<PixelInterval> intervals =
            pixel_intervals(result.film, result.luminances, 0.95, settings.allocation_or_null());
        std::array<Count, classes> classes_now{};
        std::array<Count, interval_rules> rules_now{};
        for_each_pixel(result.film, [&](std::size_t i, int x, int y) {
          if (!pixels[i].is_noisy()) return;
          const double truth = pixels[i].truth;
          const double error = (luminance(result.film.at(x, y).mean) - truth) / truth;
          const double half_width = intervals[i].luminance_half_width / truth;
          // Floats are not more exact than that.
          const bool is_covered = std::abs(error) <= half_width + 1e-5;
          const bool is_trusted =
              intervals[i].rule == IntervalRule::student_t || intervals[i].rule == IntervalRule::neighbours;
          const PixelClass of_pixel = pixels[i].class_at(samples);
          for (Count* count : {&classes_now[of_pixel], &rules_now[std::size_t(intervals[i].rule)]}) {
            count->pixels += 1;
            count->covered += is_covered;
            count->trusted += is_trusted;
            count->covered_where_trusted += is_covered && is_trusted;
          }
          if (!is_trusted) return;
          widths[i].error_sq += error * error;
          widths[i].half_width += half_width;
          widths[i].count += 1;
        });
        const auto add = [](Coverage& to, const Count& count) {
          if (count.pixels == 0) return;
          to.covered.add(count.covered / count.pixels);
          to.trusted.add(count.trusted / count.pixels);
          if (count.trusted > 0) to.covered_where_trusted.add(count.covered_where_trusted / count.trusted);
        };
        for (std::size_t c = 0; c < classes; ++c) add(by_class[c], classes_now[c]);
        for (std::size_t r = 0; r < by_rule.size(); ++r) add(by_rule[r], rules_now[r]);
      }
      fmt::print("{}, {} samples, {} replicates by {}\n", integrator, samples, replicates,
                 replicates_by_name(by));
      for (std::size_t c = 0; c < classes; ++c)
        if (by_class[c].covered.count > 0)
          fmt::print("  {:<11} all {}  trusted {:5.1f} %: {}  half-width {:.2f} true errors\n",
                     class_names[c], share_text(by_class[c].covered), 100 * by_class[c].trusted.mean,
                     share_text(by_class[c].covered_where_trusted),
                     median_width(pixels, widths, PixelClass(c), samples));
      for (std::size_t r = 0; r < by_rule.size(); ++r)
        if (by_rule[r].covered.count > 0) fmt::print("  rule {}: {}\n", r, share_text(by_rule[r].covered));
      std::fflush(stdout);
    }
}

/// Every pixel sees the same point, whose light is known.
void measure_exact(const std::string& integrator, int width_px, const Runs& runs) {
  const Vec3d center{-0.4, 0.5, 1}, half_u{0.8, 0.1, 0.2}, half_v{0.1, -0.7, 0.1};
  const LoadedScene loaded =
      load_scene_text(camera_xml({1.5, -2.5, 2}, {0, 0, 0}, 0.001, width_px, "sobol") +
                      rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, diffuse_xml(0.6)) +
                      rectangle_xml(center, half_u, half_v, light_xml(3)));
  const double exact = 0.6 / std::numbers::pi *
                       polygon_irradiance(rectangle_corners(center, half_u, half_v), 3, {0, 0, 0}, {0, 0, 1});
  fmt::print("a point under a rectangle, {} x {} times\n", width_px, width_px);
  measure(loaded.scene, integrator, runs, exact);
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"How often intervals hold the true value"};
  std::vector<std::string> files, integrators{"direct_light"};
  int width_px = 48;
  Runs runs{.samples = 64, .seeds = 200, .are_adaptive = false};
  app.add_option("SCENE", files, "Scene files; the exact one is measured in any case");
  app.add_option("--integrator", integrators, "May be repeated")->capture_default_str();
  app.add_option("--seeds", runs.seeds, "Renders of each kind")->capture_default_str();
  app.add_option("--width", width_px, "Of the image, in pixels")->capture_default_str();
  app.add_option("--spp", runs.samples, "Samples a pixel")->capture_default_str();
  app.add_flag("--adaptive", runs.are_adaptive, "Shared among the pixels by their errors");
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "share of pixels and seeds whose 95 % interval holds the true value, with a 95 % interval of that "
      "share "
      "over seeds; trusted: rules 0 and 1;\nhalf-width over the true error where trusted, in the median "
      "pixel\n");
  for (const std::string& integrator : integrators) {
    measure_exact(integrator, width_px, runs);
    for (const std::string& file : files) {
      Scene scene = std::move(load_scene(read_nori_xml(file)).scene);
      scene.sampler = SamplerKind::sobol;
      bench::shrink(scene.camera, width_px);
      fmt::print("{}, {} x {}\n", file, scene.camera.width_px, scene.camera.height_px);
      measure(scene, integrator, runs, 0);
    }
  }
} catch (const std::exception& error) {
  fmt::print(stderr, "error: {}\n", error.what());
  return 2;
}

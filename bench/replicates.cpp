// What a pixel's error bar is worth: its coverage and width, and the variance of the estimate, for replicates
// that are blocks of one sequence and for scramblings of their own. docs/conventions.md has the figures.

#include "generated_scenes.h"
#include "render/render.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "stats/running.h"
#include "stats/t_test.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace {

using namespace etendue;

/// What a pixel is like. `skewed`: few of its samples decide, whatever else it is.
enum PixelClass { smooth, penumbra, edge, skewed, classes };
constexpr std::array<const char*, classes> class_names{"smooth", "penumbra", "edge", "skewed"};

struct Pixel {
  double truth = 0;
  double relative_error_sq = 0;  ///< Of one sample.
  double skewness = 0;           ///< Of one sample.
  bool is_edge = false;          ///< It sees surfaces of different normals.

  bool is_lit() const { return truth > 0 && relative_error_sq > 0; }
  /// Student's t over replicate means holds where their skewness is small beside the root of their number.
  PixelClass class_at(int samples) const {
    if (16 * skewness * skewness > samples) return skewed;
    return is_edge ? edge : relative_error_sq < 0.25 ? smooth : penumbra;
  }
};

/// All channels agree on what is light, so one of them is enough.
RunningStatistics green(const PixelStatistics& pixel) {
  return {pixel.count, pixel.mean.g, pixel.m2.g, pixel.m3.g};
}

template <class Function>
void for_each_pixel(const Film& film, Function&& f) {
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) f(std::size_t(y * film.width() + x), green(film.at(x, y)));
}

Film render_with(const Scene& scene, const char* integrator, int samples, int replicates, ReplicatesBy by,
                 std::uint64_t seed) {
  RenderSettings settings;
  settings.integrator = integrator_from_name(integrator);
  settings.samples_per_pixel = samples;
  settings.replicates = replicates;
  settings.replicates_by = by;
  settings.seed = seed;
  settings.isa = available_isas().back();
  return render(scene, settings).film;
}

std::vector<Pixel> look_at(const Scene& scene, const char* integrator, int reference_samples) {
  std::vector<Pixel> pixels(std::size_t(scene.camera.width_px) * std::size_t(scene.camera.height_px));
  constexpr int samples = 4096;
  for_each_pixel(render_with(scene, integrator, samples, samples, ReplicatesBy::block, 99),
                 [&](std::size_t i, const RunningStatistics& pixel) {
                   pixels[i].relative_error_sq = pixel.variance() / (pixel.mean * pixel.mean);
                   pixels[i].skewness = pixel.skewness();
                 });
  for_each_pixel(
      render_with(scene, "normals", 64, 64, ReplicatesBy::block, 99),
      [&](std::size_t i, const RunningStatistics& pixel) { pixels[i].is_edge = pixel.variance() > 1e-4; });
  for_each_pixel(render_with(scene, integrator, reference_samples, 8, ReplicatesBy::block, 12345),
                 [&](std::size_t i, const RunningStatistics& pixel) { pixels[i].truth = pixel.mean; });
  return pixels;
}

struct ClassSums {
  double bars = 0, covered = 0, error_sq = 0, width_sq = 0;
  void add(const ClassSums& more) {
    bars += more.bars;
    covered += more.covered;
    error_sq += more.error_sq;
    width_sq += more.width_sq;
  }
};

void measure(Scene& scene, const char* integrator, int seeds, int reference_samples) {
  scene.sampler = SamplerKind::sobol;
  const std::vector<Pixel> pixels = look_at(scene, integrator, reference_samples);
  for (const int samples : {16, 64, 256}) {
    double one_sequence = 0;
    for (const ReplicatesBy by : {ReplicatesBy::block, ReplicatesBy::scrambling})
      for (const int replicates : {8, 16, 32}) {
        if (replicates > samples || (by == ReplicatesBy::scrambling && replicates > 8)) continue;
        std::array<ClassSums, classes> sums{};
        for (int seed = 0; seed < seeds; ++seed)
          for_each_pixel(render_with(scene, integrator, samples, replicates, by, std::uint64_t(seed)),
                         [&](std::size_t i, const RunningStatistics& pixel) {
                           if (!pixels[i].is_lit()) return;
                           const double truth = pixels[i].truth;
                           // Relative to the pixel, so that no bright one decides.
                           const double error = (pixel.mean - truth) / truth;
                           const Interval bar = student_t_interval(pixel, 0.95);
                           const double half = 0.5 * (bar.upper - bar.lower) / truth;
                           // Floats are not more exact than that.
                           sums[pixels[i].class_at(samples)].add(
                               {1, double(std::abs(error) <= half + 1e-5), error * error, half * half});
                         });
        ClassSums all;
        for (int c = 0; c < skewed; ++c) all.add(sums[std::size_t(c)]);
        const double lit = all.bars + sums[skewed].bars;
        if (by == ReplicatesBy::block && replicates == 8) one_sequence = all.error_sq / all.bars;
        fmt::print("{:<6} {:>4} {:<11}{:>3}  {:3.0f} %  x {:5.2f}  {:5.1f} %  {:5.1f} |", integrator, samples,
                   replicates_by_name(by), replicates, 100 * all.bars / lit,
                   all.error_sq / all.bars / one_sequence, 100 * all.covered / all.bars,
                   std::sqrt(all.width_sq / all.error_sq));
        for (int c = 0; c < classes; ++c) {
          const ClassSums& s = sums[std::size_t(c)];
          if (s.bars > 0)
            fmt::print("  {} {:.1f} % {:.1f}", class_names[std::size_t(c)], 100 * s.covered / s.bars,
                       std::sqrt(s.width_sq / s.error_sq));
        }
        fmt::print("\n");
        std::fflush(stdout);
      }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Coverage and width of error bars, and variance, by how replicates are made"};
  std::vector<std::string> files;
  int seeds = 16, width_px = 96, reference_samples = 1 << 14;
  app.add_option("SCENE", files, "Scene files")->required();
  app.add_option("--seeds", seeds, "Renders of each kind")->capture_default_str();
  app.add_option("--width", width_px, "Of the image, in pixels")->capture_default_str();
  app.add_option("--reference", reference_samples, "Samples a pixel of the reference")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "integrator, samples a pixel, replicates; share of lit pixels that are not skewed; of these: variance "
      "over that of one sequence; coverage of 95 % bars;\n"
      "half a bar over the true standard deviation (root of mean squares); without skewed pixels | by "
      "class\n");
  for (const std::string& file : files) {
    Scene scene = std::move(load_scene(read_nori_xml(file)).scene);
    bench::shrink(scene.camera, width_px);
    fmt::print("{}, {} x {}\n", file, scene.camera.width_px, scene.camera.height_px);
    for (const char* integrator : {"light", "mis"}) measure(scene, integrator, seeds, reference_samples);
  }
} catch (const std::exception& error) {
  fmt::print(stderr, "error: {}\n", error.what());
  return 2;
}

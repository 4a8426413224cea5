// From an OBJ file to the first pixels: where the time goes, for a mesh of a million triangles.

#include "geometry/obj_reader.h"
#include "geometry/raycast.h"
#include "render/kernel.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace {

using namespace etendue;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A wavy sheet of 2 cells^2 triangles.
void write_obj(const std::filesystem::path& file, int cells, bool has_normals) {
  std::ofstream out(file);
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double x = 10.0 * i / cells - 5, z = 10.0 * j / cells - 5;
      out << fmt::format("v {:.6f} {:.6f} {:.6f}\n", x, 0.3 * std::sin(3 * x) * std::cos(4 * z), z);
      if (has_normals)
        out << fmt::format("vn {:.6f} {:.6f} {:.6f}\n", -0.9 * std::cos(3 * x) * std::cos(4 * z), 1.0,
                           1.2 * std::sin(3 * x) * std::sin(4 * z));
    }
  const auto corner = [&](int i, int j) {
    const int index = j * (cells + 1) + i + 1;
    return has_normals ? fmt::format("{0}//{0}", index) : fmt::format("{}", index);
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      out << fmt::format("f {} {} {}\n", corner(i, j), corner(i, j + 1), corner(i + 1, j));
      out << fmt::format("f {} {} {}\n", corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
    }
}

double read_seconds(const std::filesystem::path& file, Mesh& mesh) {
  const Clock::time_point start = Clock::now();
  mesh = read_obj(file, Transform{});
  return seconds_since(start);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Seconds from an OBJ file to the first pixels"};
  bool is_json = false;
  int cells = 810;
  app.add_flag("--json", is_json, "JSON on standard output");
  app.add_option("--cells", cells, "The mesh has 2 cells^2 triangles")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("etendue-start-up-{}", getpid());
  std::filesystem::create_directory(folder);
  write_obj(folder / "flat.obj", cells, false);
  write_obj(folder / "smooth.obj", cells, true);
  const double megabytes = 1e-6 * double(std::filesystem::file_size(folder / "smooth.obj"));

  Mesh mesh;
  const double flat_seconds = read_seconds(folder / "flat.obj", mesh);
  const double smooth_seconds = read_seconds(folder / "smooth.obj", mesh);
  std::filesystem::remove_all(folder);

  Geometry geometry;
  geometry.add_mesh(mesh, {0, 0});
  const Clock::time_point build_start = Clock::now();
  RayCaster rays(geometry);
  const double build_seconds = seconds_since(build_start);

  Camera camera;
  camera.width_px = camera.height_px = 32;
  camera.origin = {0, 5, 0};
  camera.at_film_origin = {-1, -1, -1};
  camera.per_px_x = {1.0f / 16, 0, 0};
  camera.per_px_y = {0, 0, 1.0f / 16};
  Lights lights;
  lights.add<MeshLights>({1, 1, 1}, "sheet", geometry, 0);
  const Scene scene{.camera = camera,
                    .filter = PixelFilter::box(),
                    .geometry = std::move(geometry),
                    .rays = std::move(rays),
                    .materials = Materials({Diffuse{}}),
                    .lights = std::move(lights),
                    .medium = std::nullopt,
                    .sampler = SamplerKind::sobol};
  RenderSettings settings;
  settings.samples_per_pixel = 1;
  settings.replicates = 1;
  settings.isa = available_isas().back();
  const double render_seconds = render(scene, settings).seconds;

  const double total = smooth_seconds + build_seconds + render_seconds;
  const nlohmann::ordered_json json{{"triangles", mesh.triangle_count()},
                                    {"megabytes", megabytes},
                                    {"seconds_read_without_normals", flat_seconds},
                                    {"seconds_normals", smooth_seconds - flat_seconds},
                                    {"seconds_embree", build_seconds},
                                    {"seconds_first_pixels", render_seconds},
                                    {"seconds", total}};
  if (is_json) {
    fmt::print("{}\n", json.dump(2));
    return 0;
  }
  fmt::print("{} triangles, {:.0f} MB of OBJ: {:.2f} s to the first pixels\n", mesh.triangle_count(),
             megabytes, total);
  const auto share = [&](const char* what, double seconds) {
    fmt::print("  {:<22} {:.2f} s, {:.0f} %\n", what, seconds, 100 * seconds / total);
  };
  share("reading positions", flat_seconds);
  share("vertex normals", smooth_seconds - flat_seconds);
  share("Embree's tree", build_seconds);
  share("first 32x32 pixels", render_seconds);
}

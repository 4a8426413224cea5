// From files to the first pixels: where the time goes, for a mesh of a million triangles and for 200,000
// shapes, and the memory of the latter.

#include "geometry/obj_reader.h"
#include "geometry/raycast.h"
#include "render/kernel.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "scenefile/scene_files.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <unistd.h>
#include <vector>

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

/// 32x32 pixels, one sample each.
double first_pixels_seconds(const Scene& scene) {
  RenderSettings settings;
  settings.samples_per_pixel = 1;
  settings.replicates = 1;
  settings.isa = available_isas().back();
  return render(scene, settings).seconds;
}

/// VmRSS or VmHWM of this process, in bytes.
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kib; word == key + ":" && status >> kib) return 1024 * kib;
  return 0;
}

/// Gives back what is free, so that growth is what is in use.
double resident_bytes() {
  malloc_trim(0);
  return memory("VmRSS");
}
void restart_peak() {
  resident_bytes();
  std::ofstream("/proc/self/clear_refs") << 5;
}

/// A grid of `count` shapes, each as `shape(its place)` writes it, under a point light.
template <class Function>
void write_shapes(const std::filesystem::path& file, int count, const Function& shape) {
  std::ofstream out(file);
  out << "<scene><camera type=\"perspective\"><float name=\"fov\" value=\"40\"/>"
         "<integer name=\"width\" value=\"32\"/><integer name=\"height\" value=\"32\"/><transform "
         "name=\"toWorld\">"
         "<lookat origin=\"0 60 60\" target=\"0 0 0\" up=\"0 1 0\"/></transform></camera>\n"
         "<emitter type=\"point\"><point name=\"position\" value=\"0 50 0\"/></emitter>\n";
  for (int i = 0; i < count; ++i)
    out << shape(
        fmt::format("<transform name=\"toWorld\"><scale value=\"0.04\"/><rotate axis=\"1 0 0\" "
                    "angle=\"-90\"/><translate value=\"{:.3f} {:.3f} {:.3f}\"/></transform>",
                    i % 500 * 0.1 - 25, 0.3 * std::sin(0.01 * i), i / 500 * 0.1 - 20));
  out << "</scene>\n";
}

/// The same triangles as one mesh: what they cost however they are cut into shapes.
double bytes_as_one_mesh(const Geometry& shapes) {
  const double before = resident_bytes();
  Geometry geometry;
  {
    Mesh mesh;
    mesh.positions.assign(shapes.positions.begin(), shapes.positions.end() - 1);
    mesh.indices.assign(shapes.indices.begin(), shapes.indices.end());
    geometry.add_mesh(mesh, {0});
  }
  const RayCaster rays(geometry);
  return resident_bytes() - before;
}

nlohmann::ordered_json measure_shapes(const std::string& what, const std::filesystem::path& file, int count) {
  restart_peak();
  const double before = memory("VmRSS");
  const Clock::time_point start = Clock::now();
  auto description = std::make_unique<const SceneDesc>(read_nori_xml(file));
  const double parse_seconds = seconds_since(start);
  const LoadedScene loaded = load_scene(*description);
  const Clock::time_point hash_start = Clock::now();
  scene_hash(*description);
  const double hash_seconds = seconds_since(hash_start);
  const double render_seconds = first_pixels_seconds(loaded.scene), seconds = seconds_since(start);
  const double peak = memory("VmHWM") - before;
  description.reset();
  const double scene = resident_bytes() - before;
  return {{"scene", what},
          {"shapes", count},
          {"megabytes", 1e-6 * double(std::filesystem::file_size(file))},
          {"seconds_xml", parse_seconds},
          {"seconds_load", loaded.seconds_read},
          {"seconds_embree", loaded.seconds_build},
          {"seconds_hash", hash_seconds},
          {"seconds_first_pixels", render_seconds},
          {"seconds", seconds},
          {"materials", loaded.scene.materials.count()},
          {"bytes_a_shape", scene / count},
          {"bytes_a_shape_as_one_mesh", bytes_as_one_mesh(loaded.scene.geometry) / count},
          {"peak_bytes_a_shape", peak / count}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Seconds from an OBJ file, and from scenes of many shapes, to the first pixels"};
  bool is_json = false;
  int cells = 810, shapes = 200000;
  app.add_flag("--json", is_json, "JSON on standard output");
  app.add_option("--cells", cells, "The mesh has 2 cells^2 triangles")->capture_default_str();
  app.add_option("--shapes", shapes, "How many shapes the scenes of many have")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("etendue-start-up-{}", getpid());
  std::filesystem::create_directory(folder);

  // First, while the process is small: what it has once used and given back would be found again.
  std::ofstream(folder / "triangle.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  write_shapes(folder / "rectangles.xml", shapes, [](const std::string& placed) {
    return "<shape type=\"rectangle\">" + placed + "</shape>\n";
  });
  write_shapes(folder / "meshes.xml", shapes, [](const std::string& placed) {
    return "<mesh type=\"obj\"><string name=\"filename\" value=\"triangle.obj\"/>" + placed + "</mesh>\n";
  });
  const std::vector<nlohmann::ordered_json> many{
      measure_shapes("rectangles", folder / "rectangles.xml", shapes),
      measure_shapes("meshes of one triangle", folder / "meshes.xml", shapes)};

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
  camera.start = {0, 5, 0};
  camera.at_film_origin = {-1, -1, -1};
  camera.per_px_x = {1.0 / 16, 0, 0};
  camera.per_px_y = {0, 0, 1.0 / 16};
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
  const double render_seconds = first_pixels_seconds(scene);

  const double total = smooth_seconds + build_seconds + render_seconds;
  const nlohmann::ordered_json json{{"triangles", mesh.triangle_count()},
                                    {"megabytes", megabytes},
                                    {"seconds_read_without_normals", flat_seconds},
                                    {"seconds_normals", smooth_seconds - flat_seconds},
                                    {"seconds_embree", build_seconds},
                                    {"seconds_first_pixels", render_seconds},
                                    {"seconds", total},
                                    {"many_shapes", many}};
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
  for (const auto& scene_of_many : many) {
    const auto get = [&](const char* key) { return scene_of_many[key].get<double>(); };
    fmt::print("{} {}, {:.0f} MB of XML: {:.2f} s to the first pixels\n", shapes,
               scene_of_many["scene"].get<std::string>(), get("megabytes"), get("seconds"));
    fmt::print(
        "  reading the XML {:.2f} s, shapes {:.2f} s, Embree's tree {:.2f} s, hash {:.2f} s, pixels {:.2f} "
        "s\n",
        get("seconds_xml"), get("seconds_load"), get("seconds_embree"), get("seconds_hash"),
        get("seconds_first_pixels"));
    fmt::print("  bytes a shape: {:.0f}; as one mesh {:.0f}; at the peak, while reading, {:.0f}\n",
               get("bytes_a_shape"), get("bytes_a_shape_as_one_mesh"), get("peak_bytes_a_shape"));
  }
}

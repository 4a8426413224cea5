// Scenes for tests, written as text and read as a user's would be.
#pragma once

#include "closed_forms.h"
#include "render/render.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// A file that lies beside the scene: an OBJ.
struct SceneFile {
  std::string name, text;
};

/// Loads `<scene>` + body + `</scene>`.
inline LoadedScene load_scene_text(const std::string& body, const std::vector<SceneFile>& files = {}) {
  const test::TemporaryFolder folder;
  for (const SceneFile& file : files) std::ofstream(folder.path() / file.name) << file.text;
  std::ofstream(folder.path() / "scene.xml") << "<scene>\n" << body << "</scene>\n";
  return load_scene(read_nori_xml(folder.path() / "scene.xml", Dialect::nori_2012));
}

inline std::string text_of(const Vec3d& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

/// A square image of `side_px`; box filter. \param more parameters, as XML
inline std::string camera_xml(const Vec3d& origin, const Vec3d& target, double fov_deg, int side_px,
                              std::string_view sampler, std::string_view more = {}) {
  const Vec3d along = normalize(target - origin);
  const Vec3d up = std::abs(along.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  return fmt::format(
      "<sampler type=\"{}\"/>\n<camera type=\"perspective\"><transform name=\"toWorld\"><scale "
      "value=\"-1,1,1\"/>"
      "<lookat origin=\"{}\" target=\"{}\" up=\"{}\"/></transform><float name=\"fov\" value=\"{}\"/>"
      "<integer name=\"width\" value=\"{}\"/><integer name=\"height\" value=\"{}\"/><rfilter "
      "type=\"box\"/>{}</camera>\n",
      sampler, text_of(origin), text_of(target), text_of(up), fov_deg, side_px, side_px, more);
}

inline std::string light_xml(double radiance) {
  return fmt::format("<luminaire type=\"area\"><color name=\"radiance\" value=\"{}\"/></luminaire>",
                     radiance);
}
inline std::string diffuse_xml(double albedo) {
  return fmt::format("<bsdf type=\"diffuse\"><color name=\"albedo\" value=\"{}\"/></bsdf>", albedo);
}
inline std::string phong_xml(double kd, double ks, double exponent) {
  return fmt::format(
      "<bsdf type=\"phong\"><color name=\"kd\" value=\"{}\"/><color name=\"ks\" value=\"{}\"/>"
      "<float name=\"n\" value=\"{}\"/></bsdf>",
      kd, ks, exponent);
}

/// The parallelogram center +- half_u +- half_v; its front is where half_u x half_v points.
inline std::string rectangle_xml(const Vec3d& center, const Vec3d& half_u, const Vec3d& half_v,
                                 std::string_view inside) {
  const Vec3d n = normalize(cross(half_u, half_v));
  return fmt::format(
      "<shape type=\"rectangle\"><transform name=\"toWorld\"><matrix value=\"{} {} {} {} {} {} {} {} {} {} "
      "{} {} 0 0 0 1\"/>"
      "</transform>{}</shape>\n",
      half_u.x, half_v.x, n.x, center.x, half_u.y, half_v.y, n.y, center.y, half_u.z, half_v.z, n.z, center.z,
      inside);
}
inline std::vector<Vec3d> rectangle_corners(const Vec3d& c, const Vec3d& u, const Vec3d& v) {
  return {c - u - v, c + u - v, c + u + v, c - u + v};
}

inline std::string sphere_xml(const Vec3d& center, double radius, std::string_view inside) {
  return fmt::format(
      "<shape type=\"sphere\"><point name=\"center\" value=\"{}\"/><float name=\"radius\" value=\"{}\"/>"
      "{}</shape>\n",
      text_of(center), radius, inside);
}

inline std::string mesh_xml(std::string_view file, std::string_view inside) {
  return fmt::format("<mesh type=\"obj\"><string name=\"filename\" value=\"{}\"/>{}</mesh>\n", file, inside);
}

/// A convex polygon as a fan of triangles.
inline std::string polygon_obj(const std::vector<Vec3d>& polygon) {
  std::string text;
  for (const Vec3d& p : polygon) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  for (std::size_t i = 2; i < polygon.size(); ++i) text += fmt::format("f 1 {} {}\n", i, i + 1);
  return text;
}

/// The box center +- half, facing outward, or inward.
inline std::string box_obj(const Vec3d& center, double half, bool is_inward) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += fmt::format("v {} {} {}\n", center.x + (i & 1 ? half : -half), center.y + (i & 2 ? half : -half),
                        center.z + (i & 4 ? half : -half));
  constexpr int faces[6][4] = {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5},
                               {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}};
  for (const auto& f : faces)
    text += is_inward ? fmt::format("f {} {} {}\nf {} {} {}\n", f[0], f[2], f[1], f[0], f[3], f[2])
                      : fmt::format("f {} {} {}\nf {} {} {}\n", f[0], f[1], f[2], f[0], f[2], f[3]);
  return text;
}

/// The widest instruction set of this machine, all threads. Replicates are independent: what tests conclude
/// from their errors is then neither too sure nor too careful.
inline RenderSettings render_settings(std::string_view integrator, int samples_per_pixel, int replicates,
                                      std::uint64_t seed, Heuristic heuristic = Heuristic::balance) {
  RenderSettings settings;
  settings.integrator = integrator_from_name(integrator);
  if (const PathRules* rules = settings.integrator.path_rules(); rules && rules->needs_both_pdfs())
    settings.integrator.rules = rules->with_heuristic(heuristic);
  settings.samples_per_pixel = samples_per_pixel;
  settings.replicates = replicates;
  settings.replicates_by = ReplicatesBy::scrambling;
  settings.seed = seed;
  settings.isa = available_isas().back();
  return settings;
}

}  // namespace etendue

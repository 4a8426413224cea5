#include "base/frame.h"
#include "lint/checks.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace etendue {

namespace {

std::string turn_shape_round(bool is_sphere) {
  return is_sphere
             ? "take a shape that faces inwards (a mesh with its faces turned), or set the camera outside"
             : "turn its faces round (the order of their corners), or set the camera outside";
}

/// Something that shows where no shape is.
bool has_something_else(const Scene& scene) {
  return scene.lights.infinite_count() > 0 || scene.medium.has_value();
}

/// How far along the optical axis it lies what a ray would meet without clip planes, in the camera's own
/// units.
float depth_of(const Camera& camera, const View::Seen& seen) {
  return seen.unclipped->hit.t * (camera.far_clip / seen.t_far) + camera.start_depth;
}

/// Where the share of what is in view that the clip planes hide matters.
void check_clip_planes(const LintContext& context, Findings& findings) {
  const View& view = context.view;
  const Camera& camera = context.scene.camera;
  int behind_far = 0;
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const View::Seen& seen : view.rays) {
    if (!seen.unclipped) continue;
    const float t = depth_of(camera, seen);
    nearest = std::min(nearest, t);
    farthest = std::max(farthest, t);
    behind_far += !seen.hit && seen.unclipped->hit.t >= seen.t_far;
  }
  const Location& where = context.places.far_clip.value_or(context.places.camera);
  const std::string told = fmt::format(
      "the clip planes are at {:.4g} and {:.4g} m, what is in view is {:.4g} to "
      "{:.4g} m away",
      camera.near_clip + camera.start_depth, camera.far_clip + camera.start_depth, nearest, farthest);
  const std::string remedy =
      fmt::format("set farClip beyond {:.2g}{}", 2 * farthest,
                  nearest > 1000 ? "; if these are millimetres, scale the scene by 0.001"
                                 : ", nearClip below what is seen");
  if (view.hits == 0)
    findings.add("clipped-all", where,
                 told + (has_something_else(context.scene) ? ": no shape is seen" : ": nothing is seen"),
                 remedy);
  else if (4 * behind_far > view.unclipped_hits)
    findings.add(
        "clipped-much", where,
        fmt::format("{}: {:.0f} % of it is cut off", told, 100.0 * behind_far / double(view.unclipped_hits)),
        remedy);
}

/// Whether any of some points on shapes lies within the image, for what is smaller than a grid of rays sees.
bool has_shape_in_view(const Scene& scene) {
  const Geometry& geometry = scene.geometry;
  for (const Sphere& sphere : geometry.spheres)
    if (is_in_view(scene.camera, sphere.center)) return true;
  for (const Disk& disk : geometry.disks)
    if (is_in_view(scene.camera, disk.center)) return true;
  const std::size_t vertices = geometry.indices.size(), step = std::max<std::size_t>(vertices / 20000, 1);
  for (std::size_t i = 0; i < vertices; i += step)
    if (is_in_view(scene.camera, geometry.positions[std::size_t(geometry.indices[i])])) return true;
  return false;
}

void add_inside(const LintContext& context, std::int32_t id, Findings& findings) {
  const auto at = std::size_t(id);
  const ScenePlaces::Shape& shape = context.places.shapes[at];
  const bool shines = context.scene.geometry.light[at] >= 0;
  findings.add("camera-inside", shape.where,
               fmt::format("the camera is inside of the {}, which {} black from inside", shape.name,
                           shines ? "shines outwards and is" : "is"),
               turn_shape_round(context.scene.geometry.sphere[at] >= 0));
}

/// A sphere whose back is in view, as it is for no camera outside; or a shape whose back all rays from the
/// camera meet, whatever their direction.
void check_inside(const LintContext& context, Findings& findings) {
  const Scene& scene = context.scene;
  const auto is_black_back = [&](const std::optional<ProbeHit>& hit) {
    return hit && !hit->is_front && !context.material_of(*hit).is_two_sided;
  };
  for (const View::Seen& seen : context.view.rays)
    if (is_black_back(seen.hit) && scene.geometry.sphere[std::size_t(seen.hit->hit.geometry)] >= 0)
      return add_inside(context, seen.hit->hit.geometry, findings);
  ProbeNumbers numbers(2);
  std::int32_t around = -1;
  constexpr int rays = 64;
  for (int k = 0; k < rays; ++k) {
    const auto hit = probe(scene, {scene.camera.eye(), square_to_uniform_sphere(numbers.two_units())});
    if (!is_black_back(hit) || (around >= 0 && around != hit->hit.geometry)) return;
    around = hit->hit.geometry;
  }
  add_inside(context, around, findings);
}

void check_default_clip(const LintContext& context, Findings& findings) {
  constexpr float default_in_nori = 1e4f;
  const float start_depth = context.scene.camera.start_depth;
  const float far_clip = context.scene.camera.far_clip + start_depth;
  const bool is_used = std::any_of(
      context.view.rays.begin(), context.view.rays.end(),
      [&](const View::Seen& seen) { return seen.hit && seen.hit->hit.t + start_depth > default_in_nori; });
  if (context.places.far_clip || far_clip <= default_in_nori || !is_used) return;
  findings.add(
      "clip-default-moved", context.places.camera,
      fmt::format("some of what is in view lies behind Nori's default far clip plane, 1e4 m; it is at {:.3g} "
                  "here, as the file states none",
                  far_clip),
      "state farClip; if these are millimetres, scale the scene by 0.001");
}

void check_backs(const LintContext& context, Findings& findings) {
  int backs = 0;
  const ProbeHit* example = nullptr;
  for (const View::Seen& seen : context.view.rays)
    if (seen.hit && !seen.hit->is_front && !context.material_of(*seen.hit).is_two_sided &&
        !context.scene.lights.is_twosided<float>(
            context.scene.geometry.light[std::size_t(seen.hit->hit.geometry)],
            context.scene.geometry.light[std::size_t(seen.hit->hit.geometry)] >= 0)) {
      ++backs;
      example = &*seen.hit;
    }
  if (backs < 8 || backs < context.view.hits) return;
  const ScenePlaces::Shape& shape = context.places.shapes[std::size_t(example->hit.geometry)];
  findings.add("camera-on-backs", shape.where,
               fmt::format("all that the camera sees, the {} for one, it sees from behind, where it is black",
                           shape.name),
               shape.is_turned_over
                   ? "its transform mirrors it: turn its faces round, or give the mesh vertex normals"
                   : "turn its faces round, or set the camera on the other side");
}

void check_units(const LintContext& context, Findings& findings) {
  std::vector<float> distances;
  for (const View::Seen& seen : context.view.rays)
    if (seen.unclipped) distances.push_back(depth_of(context.scene.camera, seen));
  if (distances.empty()) return;
  const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  constexpr float least = 2000, most = 1e5f;
  if (*middle < least || *middle > most) return;
  // Without one, sizes are only ratios.
  if (!context.scene.medium && context.scene.lights.dirac_count() == 0) return;
  findings.add(
      "large-units", context.places.camera,
      fmt::format("what is in view is about {:.2g} m away: are these millimetres?", *middle),
      "lengths are metres, which the coefficients of media and the intensity of point lights count in; "
      "scale the scene by 0.001 and the camera with it");
}

}  // namespace

void check_camera(const LintContext& context, Findings& findings) {
  const View& view = context.view;
  if (view.unclipped_hits > 0)
    check_clip_planes(context, findings);
  else if (!has_something_else(context.scene) && !has_shape_in_view(context.scene))
    findings.add("camera-sees-nothing", context.places.camera, "the camera looks away from all shapes",
                 "check origin, target and the signs of toWorld; a camera looks along +z of its own frame");
  check_default_clip(context, findings);
  if (view.hits > 0) check_units(context, findings);
  // Whoever shows normals or materials sees backs too.
  if (!context.subject.integrator.needs_lights()) return;
  const std::size_t before = findings.count();
  check_inside(context, findings);
  if (findings.count() == before) check_backs(context, findings);
}

}  // namespace etendue

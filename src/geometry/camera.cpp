#include "geometry/camera.h"

#include "base/reach.h"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

namespace etendue {

namespace {

using Type = Parameter::Type;

const Plugin perspective_plugin{
    "camera",
    "perspective",
    "A pinhole camera or a thin lens that looks along +z of its frame.",
    {{"width", Type::integer, "1280", "px", "Width of the image"},
     {"height", Type::integer, "720", "px", "Height of the image"},
     {"fov", Type::real, "30", "deg", "Horizontal field of view"},
     {"nearClip", Type::real, "1e-4", "m",
      "Nothing nearer is seen; unless given, less in scenes smaller than 1 m"},
     {"farClip", Type::real, "1e4", "m",
      "Nothing farther is seen; unless given, more where the scene reaches farther"},
     {"apertureRadius", Type::real, "0", "m", "Radius of the lens; 0: a pinhole"},
     {"focusDistance", Type::real, "", "m", "Of the plane that is sharp; needed where there is a lens"},
     {"toWorld", Type::transform, "", "", "World from camera; identity unless given"}},
    {"rfilter", "sampler"}};

constexpr int most_pixels_a_side = 1 << 16;

int side(const Parameters& parameters, std::string_view name) {
  const int value = parameters.integer(name);
  if (value < 1 || value > most_pixels_a_side)
    throw InputError(parameters.location(name),
                     fmt::format("'{}' is {}; it must be from 1 to {}", name, value, most_pixels_a_side));
  return value;
}

struct Lens {
  double radius = 0, focus_distance = 0;  ///< m, in the camera's own space; radius 0: a pinhole.
};

constexpr std::string_view focus_hint =
    "give the distance of what shall be sharp, in metres along the optical axis";

Lens lens_of(const Parameters& parameters, std::vector<UnreadKey>& unread) {
  const double radius = parameters.real("apertureRadius");
  if (radius < 0)
    throw InputError(parameters.location("apertureRadius"),
                     fmt::format("'apertureRadius' is {}; it must not be negative", radius),
                     "give the radius of the lens in metres, or 0 for a pinhole");
  if (radius == 0) {
    if (parameters.has("focusDistance") && !parameters.is_stated("apertureRadius"))
      unread.push_back({format_message(
          parameters.location("focusDistance"), "'focusDistance' does nothing without 'apertureRadius'",
          "a pinhole is sharp at every distance; give the radius of the lens too")});
    return {};
  }
  if (!parameters.has("focusDistance"))
    throw InputError(parameters.location("apertureRadius"),
                     "'apertureRadius' needs 'focusDistance': nobody knows what shall be sharp", focus_hint);
  if (parameters.real("focusDistance") <= 0)
    throw InputError(
        parameters.location("focusDistance"),
        fmt::format("'focusDistance' is {}; it must be positive", parameters.real("focusDistance")),
        focus_hint);
  return {radius, parameters.real("focusDistance")};
}

}  // namespace

void Camera::approach(const Sphere& scene) {
  // Depth grows by 1 along each direction of the film, and not along the film itself.
  const Vec3<double> across = cross(per_px_x, per_px_y),
                     depth_of = across * (1 / dot(across, at_film_origin));
  const Vec3<double> middle{scene.center.x, scene.center.y, scene.center.z};
  const double radius = scene.radius * length(depth_of);
  const double depth = dot(middle - origin, depth_of) - 1.5 * radius;
  if (!(depth > 1.5 * radius)) return;
  start = narrow(origin + at_film_origin * depth);
  start_per_px_x = narrow(per_px_x * depth);
  start_per_px_y = narrow(per_px_y * depth);
  near_clip = float(std::max(near_clip - depth, 0.0));
  far_clip = float(std::max(far_clip - depth, 0.0));
  start_depth = float(depth);
}

const std::vector<Plugin>& camera_plugins() {
  static const std::vector<Plugin> plugins{perspective_plugin};
  return plugins;
}

Camera make_camera(const Object& description, Dialect dialect, std::vector<UnreadKey>& unread) {
  if (description.type != perspective_plugin.name) throw unknown_plugin(description, camera_plugins());
  const Parameters parameters(description, perspective_plugin, unread);
  Camera camera;
  camera.width_px = side(parameters, "width");
  camera.height_px = side(parameters, "height");
  const double fov_deg = parameters.real("fov");
  if (!(fov_deg > 0 && fov_deg < 180))
    throw InputError(parameters.location("fov"),
                     fmt::format("'fov' is {}; it must lie between 0 and 180 degrees", fov_deg));
  camera.near_clip = float(parameters.real("nearClip"));
  camera.far_clip = float(parameters.real("farClip"));
  if (!(camera.near_clip > 0 && camera.near_clip < camera.far_clip))
    throw InputError(parameters.location("nearClip"),
                     fmt::format("the clip planes are at {} and {}; 0 < nearClip < farClip is needed",
                                 camera.near_clip, camera.far_clip));
  const Lens lens = lens_of(parameters, unread);
  const Transform world_from_camera =
      parameters.has("toWorld") ? parameters.transform("toWorld") : Transform{};
  if (!is_invertible(world_from_camera) && !is_projection_to_z(world_from_camera))
    throw InputError(
        parameters.location("toWorld"), "the camera's transform is singular",
        "in a lookat, target must differ from origin and up must not be parallel to the direction");

  // Which way film x runs is what the generations of the family disagree on; see docs/conventions.md.
  const double image_right = dialect == Dialect::nori ? -1 : 1;
  const double half_width = std::tan(0.5 * fov_deg * std::numbers::pi / 180);
  const double px = 2 * half_width / camera.width_px;
  const auto to_world = [&](const Vec3<double>& v) { return transform_vector(world_from_camera, v); };
  camera.origin = transform_point(world_from_camera, {0, 0, 0});
  camera.start = narrow(camera.origin);
  if (!is_within_reach(camera.origin))
    throw PlaceError(parameters.location("toWorld"), "the camera is too far from the origin to compute with",
                     "scale the scene to common sizes");
  camera.at_film_origin = to_world({-image_right * half_width, 0.5 * px * camera.height_px, 1});
  camera.per_px_x = to_world({image_right * px, 0, 0});
  camera.per_px_y = to_world({0, -px, 0});
  if (lens.radius > 0) {
    camera.lens_x = narrow(to_world({lens.radius, 0, 0}));
    camera.lens_y = narrow(to_world({0, lens.radius, 0}));
    camera.inv_focus_distance = float(1 / lens.focus_distance);
    camera.has_lens = true;
    if (!std::isfinite(length_sq(camera.lens_x)) || !std::isfinite(length_sq(camera.lens_y)) ||
        !std::isfinite(length_sq(camera.lens_x * camera.inv_focus_distance)))
      throw InputError(parameters.location("apertureRadius"),
                       fmt::format("a lens of radius {} focused at {} is too large to compute with",
                                   lens.radius, lens.focus_distance),
                       "both are in metres; common lenses have a radius of a few millimetres");
  }
  return camera;
}

}  // namespace etendue

#include "scene/load_shape.h"

#include "base/reach.h"
#include "geometry/obj_reader.h"
#include "geometry/ply_reader.h"
#include "geometry/repeated_triangles.h"
#include "geometry/shapes.h"
#include "scenefile/existing_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace etendue {

namespace {

using Type = Parameter::Type;

const std::vector<std::string> surface_children{"bsdf", "brdf", "emitter", "luminaire"};
const Parameter to_world_parameter{"toWorld", Type::transform, "", "",
                                   "World from object; identity unless given"};

const Plugin obj_plugin{
    "shape",
    "obj",
    "A triangle mesh from a Wavefront OBJ file; written as <mesh type=\"obj\"> or <shape type=\"obj\">.",
    {{"filename", Type::text, "", "", "The file, relative to the scene file", true},
     to_world_parameter,
     {"materials", Type::boolean, "false", "", "With the materials of the MTL files that it names"},
     {"usemtl", Type::text, "", "", "Only the faces of this material"}},
    surface_children};
const Plugin ply_plugin{
    "shape",
    "ply",
    "A triangle mesh from a PLY file, ASCII or binary; written as <mesh type=\"ply\"> or <shape "
    "type=\"ply\">.",
    {{"filename", Type::text, "", "", "The file, relative to the scene file", true}, to_world_parameter},
    surface_children};
const Plugin sphere_plugin{
    "shape",
    "sphere",
    "A sphere, exact.",
    {{"center", Type::point, "0 0 0", "m", "Centre"},
     {"radius", Type::real, "1", "m", "Radius"},
     {"uOffset", Type::real, "0", "", "Added to u, from 0 to below 1; 0.5 is ETH's u of 2020"},
     to_world_parameter},
    surface_children};
const Plugin rectangle_plugin{"shape",
                              "rectangle",
                              "The square [-1, 1] x [-1, 1] at z = 0, facing +z, under toWorld.",
                              {to_world_parameter},
                              surface_children};

const Plugin disk_plugin{"shape",
                         "disk",
                         "The disk of radius 1 at z = 0, facing +z, under toWorld; exact.",
                         {to_world_parameter},
                         surface_children};

Transform world_from_object(const Parameters& parameters) {
  if (!parameters.has("toWorld")) return {};
  const Transform transform = parameters.transform("toWorld");
  if (!is_invertible(transform))
    throw InputError(parameters.location("toWorld"), "this transform is singular: it flattens the shape",
                     "check for a scale of 0 and for entries that are not finite");
  return transform;
}

std::string name_of_shape(const Object& object, const std::string& fallback) {
  return object.name.empty() ? fallback : object.name;
}

/// Throws where floats cannot tell the shape's corners apart, its area is not finite, or it is out of reach.
void check_extent(const Object& object, const Vec3f& corner, const Vec3f& along_x, const Vec3f& along_y) {
  const float area_sq = length_sq(cross(along_x, along_y));
  if (!(area_sq > 0) || !std::isfinite(area_sq) || !is_within_reach(corner) ||
      !is_within_reach(corner + along_x) || !is_within_reach(corner + along_y))
    throw PlaceError(object.location,
                     fmt::format("this {} has no area that can be computed with", object.type),
                     "it is too small, too large, or too far from the origin for its size");
}

Sphere make_sphere(const Parameters& parameters) {
  const Transform transform = world_from_object(parameters);
  const double radius = parameters.real("radius");
  if (!(radius > 0))
    throw InputError(parameters.location("radius"),
                     fmt::format("'radius' is {}; it must be positive", radius));
  // A sphere stays one only under a transform that scales all directions alike.
  const Vec3<double> x = transform_vector(transform, {1, 0, 0}), y = transform_vector(transform, {0, 1, 0}),
                     z = transform_vector(transform, {0, 0, 1});
  const double along_x = length(x), along_y = length(y), along_z = length(z);
  const double shear = std::max({std::abs(dot(x, y)), std::abs(dot(y, z)), std::abs(dot(z, x))});
  if (std::max({along_x, along_y, along_z}) > 1.0001 * std::min({along_x, along_y, along_z}) ||
      shear > 1e-4 * along_x * along_x)
    throw InputError(
        parameters.location("toWorld"),
        fmt::format("this transform makes an ellipsoid (it scales the axes by {:.4g}, {:.4g}, {:.4g})",
                    along_x, along_y, along_z),
        "scale all axes alike and do not shear, or use a mesh");
  const Vec3<double> center = transform_point(transform, parameters.point("center"));
  const Sphere sphere{narrow(center), float(radius * along_x)};
  if (!(sphere.radius > 0) || !is_within_reach(sphere.center) || !is_within_reach(Vec3f{sphere.radius, 0, 0}))
    throw PlaceError(
        parameters.object().location,
        fmt::format("in the world this sphere has radius {:.4g} at {:.4g} {:.4g} {:.4g}: beyond what can be "
                    "rendered",
                    radius * along_x, center.x, center.y, center.z),
        "scale the scene to common sizes");
  return sphere;
}

void check_untextured(const Object& shape, const AreaLight& light) {
  if (light.texture)
    throw InputError(light.texture->where,
                     fmt::format("the radiance of a {} cannot be a texture", shape.type),
                     "take a rectangle, or a mesh with texture coordinates");
}

/// Moves a mesh along its front: each vertex along the mean normal of the triangles around it.
void lift_mesh(Mesh& mesh, float lift) {
  std::vector<Vec3<double>> across(mesh.positions.size(), {0, 0, 0});
  const auto corner = [&](std::size_t i) { return widen(mesh.positions[mesh.indices[i]]); };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3<double> area = cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i));
    for (std::size_t k = i; k < i + 3; ++k) across[mesh.indices[k]] = across[mesh.indices[k]] + area;
  }
  for (std::size_t v = 0; v < across.size(); ++v)
    if (length_sq(across[v]) > 0) {
      const Vec3<double> up = normalize(across[v]) * double(lift);
      Vec3f& p = mesh.positions[v];
      p = narrow(widen(p) + up);
    }
}

}  // namespace

bool is_bsdf(const Object& object) { return object.family == "bsdf" || object.family == "brdf"; }

const std::vector<Plugin>& shape_plugins() {
  static const std::vector<Plugin> plugins{obj_plugin, ply_plugin, sphere_plugin, rectangle_plugin,
                                           disk_plugin};
  return plugins;
}

void add_shape_geometry(const Object& object, const std::filesystem::path& directory, SurfaceIds ids,
                        const std::optional<AreaLight>& light, float lift, MeshFiles& meshes,
                        Geometry& geometry, Lights& lights, std::vector<UnreadKey>& unread,
                        std::vector<std::string>& warnings) {
  const std::string numbered = fmt::format("{} {}", object.type, geometry.count() + 1);
  if (object.type == obj_plugin.name || object.type == ply_plugin.name) {
    const bool is_obj = object.type == obj_plugin.name;
    const Parameters parameters(object, is_obj ? obj_plugin : ply_plugin, unread);
    const std::filesystem::path file = existing_file(parameters, "filename", directory, "a mesh file");
    std::optional<std::string> usemtl;
    if (is_obj && parameters.is_stated("usemtl")) usemtl = parameters.text("usemtl");
    Mesh mesh = meshes.read(object, file, world_from_object(parameters), usemtl,
                            is_obj ? read_obj_file : read_ply_file);
    const std::string name = name_of_shape(object, file.stem().string());
    const bool has_bsdf = std::any_of(object.children.begin(), object.children.end(), is_bsdf);
    // Of a single material nothing is lost where the scene file has its own.
    if (!usemtl && mesh.materials > (has_bsdf ? 1 : 0)) warnings.push_back(mesh.materials_passed_over);
    warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    if (mesh.dropped_triangles > 0)
      warnings.push_back(format_message(
          object.location, mesh.dropped_triangles == 1
                               ? fmt::format("1 triangle of '{}' has no area and is left out", name)
                               : fmt::format("{} triangles of '{}' have no area and are left out",
                                             mesh.dropped_triangles, name)));
    if (const std::size_t repeated = light ? remove_repeated_triangles(mesh) : 0; repeated > 0)
      warnings.push_back(format_message(
          object.location,
          fmt::format("{} triangle{} of the light '{}' {} there more than once; one of each shines", repeated,
                      repeated == 1 ? "" : "s", name, repeated == 1 ? "is" : "are")));
    if (lift > 0) lift_mesh(mesh, lift);
    const std::int32_t id = geometry.add_mesh(mesh, ids);
    if (light && light->texture) {
      if (mesh.uvs.empty())
        throw InputError(
            light->texture->where,
            fmt::format("the radiance of '{}' is a texture, but its mesh has no texture coordinates", name),
            "write them into the mesh file (vt of an OBJ), or take a rectangle");
      lights.add<TexturedLights>(light->strength, name, geometry, id, light->texture->radiance);
    } else if (light) {
      lights.add<MeshLights>(light->strength, name, geometry, id);
    }
  } else if (object.type == sphere_plugin.name) {
    const Parameters parameters(object, sphere_plugin, unread);
    Sphere sphere = make_sphere(parameters);
    sphere.radius += lift;
    const double u_offset = parameters.real("uOffset");
    if (!(u_offset >= 0 && float(u_offset) < 1))
      throw InputError(parameters.location("uOffset"),
                       fmt::format("'uOffset' is {}; it must be from 0 to below 1", u_offset));
    geometry.add_sphere(sphere, ids, float(u_offset));
    if (light) check_untextured(object, *light);
    if (light) lights.add<SphereLights>(light->strength, name_of_shape(object, numbered), sphere);
  } else if (object.type == rectangle_plugin.name) {
    const Parameters parameters(object, rectangle_plugin, unread);
    const Transform transform = world_from_object(parameters);
    Mesh mesh = make_rectangle(transform);
    if (lift > 0) lift_mesh(mesh, lift);
    const Vec3f &corner = mesh.positions[0], along_x = mesh.positions[1] - corner,
                along_y = mesh.positions[3] - corner;
    check_extent(object, corner, along_x, along_y);
    const std::int32_t id = geometry.add_mesh(mesh, ids);
    if (light && light->texture) {
      lights.add<TexturedLights>(light->strength, name_of_shape(object, numbered), geometry, id,
                                 light->texture->radiance);
    } else if (light) {
      // The front stays in front under a mirroring transform, as for the mesh.
      const bool is_mirrored = determinant(transform) < 0;
      lights.add<RectangleLights>(light->strength, name_of_shape(object, numbered), corner,
                                  is_mirrored ? along_y : along_x, is_mirrored ? along_x : along_y);
    }
  } else if (object.type == disk_plugin.name) {
    const Parameters parameters(object, disk_plugin, unread);
    Disk disk = make_disk(world_from_object(parameters));
    disk.center = disk.center + disk.ng * lift;
    // As far as floats tell the edge from the centre.
    check_extent(object, disk.center, (disk.center + disk.along_x) - disk.center,
                 (disk.center + disk.along_y) - disk.center);
    geometry.add_disk(disk, ids);
    if (light) check_untextured(object, *light);
    if (light) lights.add<DiskLights>(light->strength, name_of_shape(object, numbered), disk);
  } else {
    throw unknown_plugin(object, shape_plugins());
  }
}

}  // namespace etendue

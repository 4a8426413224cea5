#include "geometry/mesh_builder.h"

#include "base/reach.h"
#include "geometry/mesh_text.h"
#include "geometry/rounded_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace etendue {
namespace {}  // namespace

std::uint32_t VertexTable::find_or_add(const Corner& corner) {
  auto& first = first_of_position_[corner.position];
  if (first == Corner::none) return first = add(corner);
  if (corners_[first] == corner) return first;
  if (2 * (split_count_ + 1) > slots_.size()) grow();
  const auto slot = find_slot(corner);
  if (slots_[slot] == Corner::none) {
    slots_[slot] = add(corner);
    ++split_count_;
  }
  return slots_[slot];
}

std::uint32_t VertexTable::add(const Corner& corner) {
  corners_.push_back(corner);
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

std::size_t VertexTable::find_slot(const Corner& c) const {
  std::uint64_t hash = (std::uint64_t{c.position} << 32 | c.normal) * 0x9E3779B97F4A7C15u;
  hash = (hash ^ hash >> 32 ^ c.uv) * 0xD6E8FEB86659FD93u;
  auto slot = (hash ^ hash >> 32) & (slots_.size() - 1);
  while (slots_[slot] != Corner::none && corners_[slots_[slot]] != c) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void VertexTable::grow() {
  const auto old = std::exchange(
      slots_, std::vector<std::uint32_t>(std::max<std::size_t>(64, 2 * slots_.size()), Corner::none));
  for (const auto vertex : old)
    if (vertex != Corner::none) slots_[find_slot(corners_[vertex])] = vertex;
}

MeshParts in_world(const ObjectParts& parts, const Transform& world_from_object) {
  MeshParts world;
  world.uvs = parts.uvs;
  world.positions.reserve(parts.positions.size());
  world.normals.reserve(parts.normals.size());
  for (const Vec3<double>& position : parts.positions) {
    const auto p = transform_point(world_from_object, position);
    world.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  }
  for (const Vec3<double>& normal : parts.normals)
    world.normals.push_back(unit_or_zero(transform_normal(world_from_object, normal)));
  return world;
}

MeshBuilder::MeshBuilder(std::string name, const ObjectParts& parts, const Transform& world_from_object,
                         bool has_uvs, bool has_normals, Errors errors)
    : parts_(in_world(parts, world_from_object)),
      has_uvs_(has_uvs),
      has_normals_(has_normals),
      errors_(std::move(errors)),
      vertices_(parts_.positions.size()) {
  mesh_.name = std::move(name);
  if (const std::string rounding = float_rounding_in_file(parts.positions); !rounding.empty())
    mesh_.warnings.push_back(fmt::format(
        "{}: {}\nexport the object where it is near the origin, and put it in its place by toWorld",
        mesh_.name, rounding));
  mesh_.positions.reserve(parts_.positions.size());
  for (std::size_t i = 0; i < parts_.positions.size(); ++i) {
    const Vec3f& p = parts_.positions[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    const Vec3<double> wide = transform_point(world_from_object, parts.positions[i]);
    const double misfit = !std::isfinite(p.x) ? wide.x : !std::isfinite(p.y) ? wide.y : wide.z;
    throw PlaceError(errors_.at_position(i, fmt::format("{:g} does not fit a float", misfit),
                                         "expected coordinates, in world space, below 3e38"));
  }
}

void MeshBuilder::add_face(std::size_t face, std::span<const Corner> c) {
  if (!first_face_) first_face_ = face;
  if (c.size() == 3) return add_triangle(face, {c[0], c[1], c[2]});
  polygon_.clear();
  for (const Corner& corner : c) polygon_.push_back(widen(parts_.positions[corner.position]));
  triangulate(polygon_, triangles_);
  for (const auto& [i, j, k] : triangles_.corners) add_triangle(face, {c[i], c[j], c[k]});
  if (!triangles_.is_simple)
    crossing_.add(face);
  else if (!triangles_.is_flat)
    bent_.add(face);
}

Mesh MeshBuilder::finish() && {
  if (mesh_.indices.empty())
    throw PlaceError(errors_.at_face(first_face_.value_or(0), "no triangle has an area",
                                     "the mesh, or the transform it is given, is flat; check its scale"));
  warn(crossing_, "this polygon crosses itself, or is folded", "{} polygons cross themselves, or are folded",
       "it has no inside to fill with triangles, and gets a fan from its first corner; cut it in two");
  warn(bent_, "the corners of this polygon lie far from one plane",
       "the corners of {} polygons lie far from one plane",
       "it has no shape of its own, and gets triangles by how it looks from the front; cut it in two");
  return std::move(mesh_);
}

/// \param problems where there are several; their number for {}
void MeshBuilder::warn(const OddFaces& faces, std::string_view problem, std::string_view problems,
                       std::string_view hint) {
  if (faces.count == 0) return;
  const std::string said = faces.count == 1
                               ? std::string(problem)
                               : fmt::format(fmt::runtime(problems), faces.count) + "; the first";
  mesh_.warnings.emplace_back(errors_.at_face(faces.first, said, hint).what());
}

void MeshBuilder::add_triangle(std::size_t face, std::array<Corner, 3> corners) {
  const auto p0 = widen(parts_.positions[corners[0].position]);
  const auto p1 = widen(parts_.positions[corners[1].position]);
  const auto p2 = widen(parts_.positions[corners[2].position]);
  const auto double_area_normal = cross(p1 - p0, p2 - p0);
  const double double_area_sq = length_sq(double_area_normal);
  const double longest_sq = std::max({length_sq(p1 - p0), length_sq(p2 - p1), length_sq(p0 - p2)});
  constexpr double rounding = 0x1p-21;
  if (double_area_sq <= rounding * rounding * longest_sq * longest_sq ||
      double_area_sq < std::numeric_limits<float>::min()) {
    ++mesh_.dropped_triangles;
    return;
  }
  if (!is_within_reach(p0) || !is_within_reach(p1) || !is_within_reach(p2))
    throw PlaceError(errors_.at_face(face, "a triangle with a corner beyond 1e15 m from the origin",
                                     "scale the mesh down, or move it nearer with toWorld"));
  if (double_area_sq > std::numeric_limits<float>::max())
    throw errors_.at_face(face, "a triangle too large for single precision",
                          "scale the scene down, so that no area exceeds 1e18 square metres");
  if (has_normals_) give_normals(corners, double_area_normal);
  for (const auto& corner : corners) {
    const auto vertex = vertices_.find_or_add(corner);
    if (vertices_.size() > mesh_.positions.size()) add_vertex(corner);
    mesh_.indices.push_back(vertex);
  }
}

/// Flat where a corner lacks a normal; else turned to the side of the normals.
void MeshBuilder::give_normals(std::array<Corner, 3>& corners, const Vec3<double>& double_area_normal) {
  if (std::any_of(corners.begin(), corners.end(), [](const Corner& c) { return c.normal == Corner::none; })) {
    for (auto& corner : corners) corner.normal = static_cast<std::uint32_t>(parts_.normals.size());
    parts_.normals.push_back(unit_or_zero(double_area_normal));
    return;
  }
  Vec3<double> sum{0, 0, 0};
  for (const auto& corner : corners) {
    const auto& normal = parts_.normals[corner.normal];
    if (normal == Vec3f{0, 0, 0})
      throw errors_.at_normal(
          corner.normal, "has no direction",
          "the file or the transform makes it zero; export the mesh without normals, or write one that is "
          "not zero");
    sum = sum + widen(normal);
  }
  if (dot(double_area_normal, sum) < 0) std::swap(corners[1], corners[2]);
}

void MeshBuilder::add_vertex(const Corner& corner) {
  mesh_.positions.push_back(parts_.positions[corner.position]);
  if (has_normals_) mesh_.normals.push_back(parts_.normals[corner.normal]);
  if (has_uvs_) mesh_.uvs.push_back(corner.uv == Corner::none ? Vec2f{0, 0} : parts_.uvs[corner.uv]);
}

}  // namespace etendue

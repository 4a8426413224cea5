#include "base/hash.h"
#include "lint/checks.h"

#include <bit>
#include <fmt/format.h>
#include <unordered_map>

namespace etendue {

namespace {

void append(const Vec3f& p, std::vector<float>& numbers) { numbers.insert(numbers.end(), {p.x, p.y, p.z}); }

/// What tells a shape from others: the corners of a mesh's triangles, of which the first one alone may do.
std::vector<float> numbers_of(const Geometry& geometry, std::size_t id, bool are_all) {
  std::vector<float> numbers{float(geometry.triangles[id])};
  if (geometry.sphere[id] >= 0) {
    const Sphere& sphere = geometry.spheres[std::size_t(geometry.sphere[id])];
    append(sphere.center, numbers);
    numbers.push_back(sphere.radius);
  }
  if (geometry.disk[id] >= 0) {
    const Disk& disk = geometry.disks[std::size_t(geometry.disk[id])];
    for (const Vec3f& v : {disk.center, disk.along_x, disk.along_y}) append(v, numbers);
  }
  const std::size_t triangles =
      are_all ? std::size_t(geometry.triangles[id]) : std::size_t(geometry.triangles[id] > 0);
  for (std::size_t k = 0; k < 3 * triangles; ++k)
    append(
        geometry.positions[std::size_t(geometry.indices[3 * std::size_t(geometry.first_triangle[id]) + k])],
        numbers);
  return numbers;
}

std::uint64_t hash_of(const std::vector<float>& numbers) {
  std::uint64_t hash = 0;
  for (const float x : numbers) hash = hash64(hash ^ std::bit_cast<std::uint32_t>(x));
  return hash;
}

}  // namespace

void check_repeated_shapes(const LintContext& context, Findings& findings) {
  const Geometry& geometry = context.scene.geometry;
  std::unordered_map<std::uint64_t, std::size_t> first;
  for (std::size_t id = 0; id < std::size_t(geometry.count()); ++id) {
    if (context.is_sensitive(std::int32_t(id))) continue;  // Told of as surfaces in one place.
    const auto [found, is_new] = first.emplace(hash_of(numbers_of(geometry, id, false)), id);
    if (is_new || numbers_of(geometry, id, true) != numbers_of(geometry, found->second, true)) continue;
    const ScenePlaces::Shape &shape = context.places.shapes[id], &same = context.places.shapes[found->second];
    findings.add("repeated-shape", shape.where,
                 fmt::format("the {} is there twice, in the same place: also as {} (line {})", shape.name,
                             same.name, line_and_column(same.where).line),
                 "remove one of them: only one is seen");
  }
}

}  // namespace etendue

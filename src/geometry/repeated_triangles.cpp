#include "geometry/repeated_triangles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace etendue {
namespace {

struct Triangle {
  std::array<std::tuple<float, float, float>, 3> corners;  ///< The least first, in their turn.
  std::size_t number;
};

Triangle triangle_of(const Mesh& mesh, std::size_t number) {
  Triangle triangle{{}, number};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3f& p = mesh.positions[mesh.indices[3 * number + k]];
    triangle.corners[k] = {p.x, p.y, p.z};
  }
  std::rotate(triangle.corners.begin(), std::min_element(triangle.corners.begin(), triangle.corners.end()),
              triangle.corners.end());
  return triangle;
}

}  // namespace

std::size_t remove_repeated_triangles(Mesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) triangles.push_back(triangle_of(mesh, i));
  std::sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
    return std::tie(a.corners, a.number) < std::tie(b.corners, b.number);
  });
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (i == 0 || triangles[i].corners != triangles[i - 1].corners) kept.push_back(triangles[i].number);
  const std::size_t removed = triangles.size() - kept.size();
  if (removed == 0) return 0;
  std::sort(kept.begin(), kept.end());
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * kept.size());
  for (const std::size_t number : kept)
    for (std::size_t k = 0; k < 3; ++k) indices.push_back(mesh.indices[3 * number + k]);
  mesh.indices = std::move(indices);
  return removed;
}

}  // namespace etendue

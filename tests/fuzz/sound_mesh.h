// What every mesh that a reader returns must keep, whatever the file held.
#pragma once

#include "geometry/mesh.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace etendue {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "the mesh breaks its promise: %s\n", what);
  std::abort();
}

inline void require_sound(const Mesh& mesh) {
  const auto is_finite = [](const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  require(!mesh.indices.empty() && mesh.indices.size() % 3 == 0, "triangles");
  require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "a normal each vertex");
  require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size(), "a uv each vertex");
  for (const std::uint32_t index : mesh.indices) require(index < mesh.positions.size(), "indices in range");
  for (const Vec3f& p : mesh.positions) require(is_finite(p), "finite positions");
  for (const Vec3f& n : mesh.normals) require(std::abs(length(n) - 1) < 1e-4f, "unit normals");
  for (const Vec2f& uv : mesh.uvs) require(std::isfinite(uv.x) && std::isfinite(uv.y), "finite uvs");
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return mesh.positions[mesh.indices[t + k]]; };
    const Vec3f across = cross(corner(1) - corner(0), corner(2) - corner(0));
    require(is_finite(across) && std::isfinite(length_sq(across)) && length_sq(across) > 0, "areas");
  }
}

}  // namespace etendue

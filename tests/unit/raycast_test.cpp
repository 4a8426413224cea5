// What rays meet in scenes of many meshes, spheres and disks: the geometry and the primitive in it.
#include "geometry/raycast.h"

#include "geometry/shapes.h"
#include "support/cast_rays.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <utility>
#include <vector>

namespace etendue {
namespace {

using Vec3d = Vec3<double>;
constexpr double none = 1e9;

/// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
double meet_triangle(const Vec3d& origin, const Vec3d& direction, const Vec3d corners[3]) {
  const Vec3d edge_1 = corners[1] - corners[0], edge_2 = corners[2] - corners[0];
  const Vec3d across = cross(direction, edge_2), offset = origin - corners[0];
  const double scale = 1 / dot(across, edge_1), u = dot(across, offset) * scale;
  const Vec3d q = cross(offset, edge_1);
  const double v = dot(q, direction) * scale, t = dot(q, edge_2) * scale;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : none;
}

double meet_sphere(const Vec3d& origin, const Vec3d& direction, const Sphere& sphere) {
  const Vec3d offset = origin - widen(sphere.center);
  const double a = length_sq(direction), b = dot(offset, direction),
               c = length_sq(offset) - double(sphere.radius) * sphere.radius, root_sq = b * b - a * c;
  if (root_sq < 0) return none;
  const double near = (-b - std::sqrt(root_sq)) / a, far = (-b + std::sqrt(root_sq)) / a;
  return near > 0 ? near : far > 0 ? far : none;
}

/// A round one.
double meet_disk(const Vec3d& origin, const Vec3d& direction, const Disk& disk) {
  const Vec3d to_center = widen(disk.center) - origin, ng = widen(disk.ng);
  const double t = dot(to_center, ng) / dot(direction, ng);
  return t > 0 && length(direction * t - to_center) <= length(widen(disk.along_x)) ? t : none;
}

struct Nearest {
  std::int32_t geometry = -1, primitive = 0;
  double t = none, second_t = none;

  void take(double found, std::int32_t id, std::int32_t number) {
    if (found < t)
      *this = {id, number, found, t};
    else
      second_t = std::min(second_t, found);
  }
};

Nearest search(const Geometry& geometry, const Vec3d& origin, const Vec3d& direction) {
  Nearest nearest;
  for (std::int32_t id = 0; id < geometry.count(); ++id) {
    const auto at = std::size_t(id);
    for (std::int32_t k = 0; k < geometry.triangles[at]; ++k) {
      Vec3d corners[3];
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = widen(geometry.positions[std::size_t(
            geometry.indices[3 * std::size_t(geometry.first_triangle[at] + k) + c])]);
      nearest.take(meet_triangle(origin, direction, corners), id, k);
    }
    if (geometry.sphere[at] >= 0)
      nearest.take(meet_sphere(origin, direction, geometry.spheres[std::size_t(geometry.sphere[at])]), id, 0);
    if (geometry.disk[at] >= 0)
      nearest.take(meet_disk(origin, direction, geometry.disks[std::size_t(geometry.disk[at])]), id, 0);
  }
  return nearest;
}

struct Counts {
  int meshes, spheres, disks;
};

/// Shapes of all kinds in [-1, 1]^3, in an order that mixes them; meshes of 1 to 40 triangles, or where there
/// are many, of 1 to 4.
Geometry mixed_geometry(const Counts& counts) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> coordinate(-1, 1), edge(-0.3f, 0.3f), radius(0.05f, 0.2f);
  std::uniform_int_distribution<int> triangles(1, counts.meshes > 100 ? 4 : 40);
  const auto vec = [&](auto& distribution) {
    const float x = distribution(engine), y = distribution(engine), z = distribution(engine);
    return Vec3f{x, y, z};
  };
  std::vector<int> kinds;
  kinds.insert(kinds.end(), std::size_t(counts.meshes), 0);
  kinds.insert(kinds.end(), std::size_t(counts.spheres), 1);
  kinds.insert(kinds.end(), std::size_t(counts.disks), 2);
  std::shuffle(kinds.begin(), kinds.end(), engine);
  Geometry geometry;
  for (const int kind : kinds) {
    const Vec3f center = vec(coordinate);
    const double size = double(radius(engine));
    if (kind == 0) {
      Mesh mesh;
      for (int k = triangles(engine); k > 0; --k)
        for (int corner = 0; corner < 3; ++corner) {
          mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
          mesh.positions.push_back(center + vec(edge));
        }
      geometry.add_mesh(mesh, {0});
    } else if (kind == 1) {
      geometry.add_sphere({center, float(size)}, {0});
    } else {
      geometry.add_disk(make_disk(translation({center.x, center.y, center.z}) *
                                  rotation(Vec3d{1, 0, 0} + widen(vec(edge)), 90.0 * double(edge(engine))) *
                                  scaling({size, size, size})),
                        {0});
    }
  }
  return geometry;
}

class MixedShapes : public testing::TestWithParam<Counts> {};

TEST_P(MixedShapes, AreMetAsBruteForceFindsThem) {
  Geometry built = mixed_geometry(GetParam());
  RayCaster first_caster(built);
  // Both may be moved once they are built.
  const Geometry geometry = std::move(built);
  const RayCaster caster = std::move(first_caster);

  std::mt19937 engine(7);
  std::uniform_real_distribution<float> coordinate(-1.5f, 1.5f);
  std::vector<Vec3f> origin, direction;
  std::vector<Nearest> expected;
  std::vector<std::int32_t> is_active;
  const std::size_t rays = geometry.count() > 100 ? 256 : 4096;
  while (origin.size() < rays) {
    const auto point = [&] {
      const float x = coordinate(engine), y = coordinate(engine), z = coordinate(engine);
      return Vec3f{x, y, z};
    };
    const Vec3f from = point(), along = point() - from;
    const Nearest nearest = search(geometry, widen(from), widen(along));
    if (nearest.t < none && nearest.second_t - nearest.t < 1e-4) continue;  // Floats might swap them.
    if (std::abs(nearest.t - 1) < 1e-4) continue;
    origin.push_back(from);
    direction.push_back(along);
    expected.push_back(nearest);
    is_active.push_back(origin.size() % 7 == 0 ? 0 : -1);
  }
  for (const int width : {1, 4, 8, 16}) {
    const test::Hits hits = test::cast_rays(caster, origin, direction, width, is_active);
    std::size_t wrong = 0, met = 0;
    for (std::size_t i = 0; i < rays; ++i) {
      if (is_active[i] == 0) {
        ASSERT_EQ(hits.geometry[i], -1);
        continue;
      }
      const Nearest& nearest = expected[i];
      met += nearest.geometry >= 0;
      wrong += hits.geometry[i] != nearest.geometry ||
               (nearest.geometry >= 0 && (hits.primitive[i] != nearest.primitive ||
                                          std::abs(double(hits.t[i]) - nearest.t) > 1e-4 * (1 + nearest.t)));
      wrong += hits.is_visible[i] != (nearest.t < 1 ? 0 : -1);
    }
    EXPECT_EQ(wrong, 0u) << "width " << width;
    EXPECT_GT(met, rays / 32) << "width " << width;
  }
}

INSTANTIATE_TEST_SUITE_P(RayCaster, MixedShapes,
                         testing::Values(Counts{20, 15, 15}, Counts{30, 0, 0}, Counts{0, 30, 0},
                                         Counts{0, 0, 60}, Counts{1, 1, 1}, Counts{0, 20, 20},
                                         // So many that ray casting joins them.
                                         Counts{5000, 2000, 2000}, Counts{9000, 0, 0},
                                         Counts{0, 4500, 4500}));

/// A ball of triangles that share their vertices, about a place that floats round.
Mesh ball_mesh(int rings, int sectors) {
  Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const double theta = ring * 3.14159265358979 / rings, phi = sector * 6.28318530717959 / sectors;
      mesh.positions.push_back({float(0.3 + std::sin(theta) * std::cos(phi)),
                                float(-0.7 + std::sin(theta) * std::sin(phi)), float(0.1 + std::cos(theta))});
    }
  const auto vertex = [&](int ring, int sector) {
    // The poles are one vertex each.
    return std::uint32_t(ring * sectors + (ring == 0 || ring == rings ? 0 : sector % sectors));
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const std::uint32_t a = vertex(ring, sector), b = vertex(ring + 1, sector),
                          c = vertex(ring + 1, sector + 1), d = vertex(ring, sector + 1);
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, b, d});
      if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {b, c, d});
    }
  return mesh;
}

/// Rays at places on edges, from all around: those that pass into the ball. Seen to fail without Embree's
/// robust mode: it is what `fast` does.
TEST(RayCaster, IsWatertightWhereAskedTo) {
  const Mesh mesh = ball_mesh(24, 37);
  Geometry geometry;
  geometry.add_mesh(mesh, {0});
  std::mt19937 engine(8);
  std::normal_distribution<float> normal;
  std::uniform_int_distribution<std::size_t> triangle(0, mesh.triangle_count() - 1);
  constexpr int rays = 1 << 19;
  const Vec3f center{0.3f, -0.7f, 0.1f};
  std::vector<Vec3f> origin, direction;
  for (int i = 0; i < rays; ++i) {
    const std::size_t first = 3 * triangle(engine);
    const Vec3f &a = mesh.positions[mesh.indices[first]], &b = mesh.positions[mesh.indices[first + 1]];
    const float along = 0.25f * float(1 + i % 3);
    const Vec3f target = a + (b - a) * along;
    // From outside, and not along the ball, where a ray may rightly miss it.
    const Vec3f from =
        target +
        normalize(target - center + normalize(Vec3f{normal(engine), normal(engine), normal(engine)}) * 0.6f) *
            3;
    origin.push_back(from);
    direction.push_back(normalize(target - from));
  }
  const auto passed = [&](Edges edges) {
    const RayCaster caster(geometry, edges);
    const test::Hits hits = test::cast_rays(caster, origin, direction, 16);
    int count = 0;
    for (std::size_t i = 0; i < hits.t.size(); ++i)
      count += hits.geometry[i] < 0 || (hits.ng_x[i] * direction[i].x + hits.ng_y[i] * direction[i].y +
                                        hits.ng_z[i] * direction[i].z) > 0;
    return count;
  };
  EXPECT_GT(passed(Edges::fast), 0) << "or this test shows nothing";
  EXPECT_EQ(passed(Edges::watertight), 0);
}

}  // namespace
}  // namespace etendue

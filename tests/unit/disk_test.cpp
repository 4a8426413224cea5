// Disks: where rays meet them, from every packet width; surface coordinates of spheres and disks.
#include "geometry/bounds.h"
#include "geometry/shapes.h"
#include "geometry/surface_uv.h"
#include "support/cast_rays.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace etendue {
namespace {

constexpr double whole_turn = 6.283185307179586;

TEST(Disk, IsMetWhereItsPlaneIsWithinTheEllipse) {
  const Transform transforms[] = {
      {},
      translation({3, -2, 5}) * rotation({1, 2, 3}, 50) * scaling({2, 0.5, 1}),
      translation({100, 0, 0}) * rotation({0, 1, 0}, 90) * scaling({-1, 3, 1}),
      Transform{{{{1, 0.8, 0, 0}, {0, 1, 0, 0}, {0.3, 0, 1, 0}, {0, 0, 0, 1}}}},
  };
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-1.2, 1.2);
  for (const Transform& transform : transforms) {
    Geometry geometry;
    geometry.add_disk(make_disk(transform), {0, -1});
    std::vector<Vec3f> origin, direction;
    std::vector<Vec2<double>> local;
    const auto narrow = [](const Vec3<double>& v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
    while (local.size() < 4096) {
      const double x = uniform(engine), y = uniform(engine);
      if (std::abs(std::hypot(x, y) - 1) < 1e-3) continue;  // floats cannot tell there
      local.push_back({x, y});
      const Vec3f from = narrow(
          transform_point(transform, {uniform(engine), uniform(engine), local.size() % 2 ? 2.0 : -1.5}));
      origin.push_back(from);
      // A little longer than to the plane, so that t = 1 lies behind it.
      direction.push_back((narrow(transform_point(transform, {x, y, 0})) - from) * 1.25f);
    }
    const auto n = normalize(transform_normal(transform, {0, 0, 1}));
    for (const int width : {1, 4, 8, 16}) {
      const test::Hits hits = test::cast_rays(RayCaster(geometry), origin, direction, width);
      for (std::size_t i = 0; i < local.size(); ++i) {
        const bool is_within = std::hypot(local[i].x, local[i].y) < 1;
        ASSERT_EQ(hits.geometry[i], is_within ? 0 : -1) << i;
        ASSERT_EQ(hits.is_visible[i], is_within ? 0 : -1) << i;
        if (!is_within) continue;
        ASSERT_NEAR(hits.t[i], 0.8, 1e-4);
        ASSERT_NEAR(hits.u[i], local[i].x, 1e-4);
        ASSERT_NEAR(hits.v[i], local[i].y, 1e-4);
        ASSERT_NEAR(hits.ng_x[i] * n.x + hits.ng_y[i] * n.y + hits.ng_z[i] * n.z, 1, 1e-5);
      }
    }
  }
}

TEST(Disk, RaysInItsPlaneMissIt) {
  Geometry geometry;
  geometry.add_disk(make_disk({}), {0, -1});
  EXPECT_EQ(test::cast_rays(RayCaster(geometry), {{-3, 0, 0}}, {{1, 0, 0}}, 1).geometry[0], -1);
}

TEST(Disk, BoundsHoldItTightly) {
  Geometry geometry;
  geometry.add_disk(make_disk(translation({1, 2, 3}) * scaling({4, 4, 4})), {0, -1});
  const Sphere bounds = bounding_sphere(geometry);
  EXPECT_EQ(bounds.center, (Vec3f{1, 2, 3}));
  EXPECT_NEAR(bounds.radius, 4 * std::sqrt(2.0), 1e-4);
}

TEST(SurfaceUv, OfSpheres) {
  const auto uv = [](double x, double y, double z) {
    const auto n = normalize(Vec3<double>{x, y, z});
    return sphere_uv<float>({float(n.x), float(n.y), float(n.z)}, 0.0f);
  };
  EXPECT_EQ(uv(1, 0, 0), (Vec2f{0, 0.5f}));
  EXPECT_EQ(uv(0, 1, 0), (Vec2f{0.25f, 0.5f}));
  EXPECT_EQ(uv(-1, 0, 0), (Vec2f{0.5f, 0.5f}));
  EXPECT_EQ(uv(0, -1, 0), (Vec2f{0.75f, 0.5f}));
  EXPECT_EQ(uv(0, 0, 1), (Vec2f{0, 0}));
  EXPECT_EQ(uv(0, 0, -1), (Vec2f{0, 1}));
  EXPECT_EQ(sphere_uv<float>({0, 1, 0}, 0.5f), (Vec2f{0.75f, 0.5f}));
  EXPECT_EQ(sphere_uv<float>({0, -1, 0}, 0.5f), (Vec2f{0.25f, 0.5f}));
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i) {
    const Vec3<double> n = normalize(Vec3<double>{normal(engine), normal(engine), normal(engine)});
    const Vec2f at = sphere_uv<float>({float(n.x), float(n.y), float(n.z)}, 0.0f);
    EXPECT_TRUE(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1);
    const double phi = whole_turn * at.x, theta = 0.5 * whole_turn * at.y;
    EXPECT_NEAR(std::sin(theta) * std::cos(phi), n.x, 2e-6);
    EXPECT_NEAR(std::sin(theta) * std::sin(phi), n.y, 2e-6);
    EXPECT_NEAR(std::cos(theta), n.z, 2e-6);
  }
}

TEST(SurfaceUv, OfDisks) {
  EXPECT_EQ(disk_uv<float>({0, 0}), (Vec2f{0, 0}));
  EXPECT_EQ(disk_uv<float>({0.5f, 0}), (Vec2f{0.5f, 0}));
  EXPECT_EQ(disk_uv<float>({0, 1}), (Vec2f{1, 0.25f}));
  EXPECT_EQ(disk_uv<float>({0, -0.25f}), (Vec2f{0.25f, 0.75f}));
}

TEST(SurfaceUv, ChoosesByShape) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {2, 0}, {0, 4}};
  mesh.indices = {0, 1, 2};
  Geometry geometry;
  geometry.add_sphere({{0, 0, 0}, 1}, {0, -1});
  geometry.add_mesh(mesh, {0, -1});
  geometry.add_disk(make_disk({}), {0, -1});
  geometry.add_mesh(mesh, {0, -1});
  const auto uv = [&](int id) { return surface_uv<float>(geometry, id, 0, {0.5f, 0.25f}, {0, 1, 0}, true); };
  EXPECT_EQ(uv(0), (Vec2f{0.25f, 0.5f}));
  EXPECT_EQ(uv(1), (Vec2f{1, 1}));
  EXPECT_NEAR(uv(2).x, std::hypot(0.5, 0.25), 1e-6);
  EXPECT_EQ(uv(3), (Vec2f{1, 1}));
  mesh.uvs.clear();
  const int bare = geometry.add_mesh(mesh, {0, -1});
  EXPECT_EQ(uv(bare), (Vec2f{0.5f, 0.25f}));
  EXPECT_EQ(uv(3), (Vec2f{1, 1}));
}

}  // namespace
}  // namespace etendue

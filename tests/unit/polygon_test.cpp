// Polygons to triangles: each point of the polygon in one triangle, each point outside in none.
#include "geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

using ::testing::ElementsAre;
using Flat = std::vector<Vec2<double>>;
using Triangle = std::array<std::uint32_t, 3>;

double twice_area_left(const Vec2<double>& a, const Vec2<double>& b, const Vec2<double>& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// By the number of edges to the right of the point.
bool is_inside(const Flat& polygon, const Vec2<double>& p) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const auto &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

enum class Plane { z, x, tilted };

std::vector<Vec3<double>> in_space(const Flat& polygon, Plane plane) {
  std::vector<Vec3<double>> corners;
  for (const auto& p : polygon) {
    if (plane == Plane::z) corners.push_back({p.x, p.y, 7});
    if (plane == Plane::x) corners.push_back({-3, p.x, p.y});
    if (plane == Plane::tilted) corners.push_back({p.x, p.y, 2 * p.x - p.y});
  }
  return corners;
}

/// The triangles turn as the polygon (to the left), and cover it and nothing else.
void expect_tiles(const Flat& polygon, const std::vector<Triangle>& triangles) {
  for (const Triangle& t : triangles)
    EXPECT_GE(twice_area_left(polygon[t[0]], polygon[t[1]], polygon[t[2]]), -1e-9) << t[0] << t[1] << t[2];
  constexpr int side = 61;  // No point of the grid lies on an edge.
  for (int i = 0; i < side * side; ++i) {
    const Vec2<double> p{-3.01 + 6.03 * (i % side) / side, -3.02 + 6.05 * (i / side) / side};
    int covers = 0;
    for (const Triangle& t : triangles)
      covers += twice_area_left(polygon[t[0]], polygon[t[1]], p) > 0 &&
                twice_area_left(polygon[t[1]], polygon[t[2]], p) > 0 &&
                twice_area_left(polygon[t[2]], polygon[t[0]], p) > 0;
    ASSERT_EQ(covers, is_inside(polygon, p) ? 1 : 0) << p.x << ' ' << p.y;
  }
}

PolygonTriangles triangles_of(const std::vector<Vec3<double>>& polygon) {
  PolygonTriangles triangles;
  triangulate(polygon, triangles);
  return triangles;
}

/// From every start corner and in several planes.
void expect_is_filled(Flat polygon) {
  for (std::size_t start = 0; start < polygon.size(); ++start) {
    for (const Plane plane : {Plane::z, Plane::x, Plane::tilted}) {
      const PolygonTriangles triangles = triangles_of(in_space(polygon, plane));
      EXPECT_TRUE(triangles.is_simple);
      EXPECT_TRUE(triangles.is_flat);
      expect_tiles(polygon, triangles.corners);
    }
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
  }
}

TEST(Polygon, convex_ones_are_fans_and_quads_as_in_nori) {
  EXPECT_THAT(triangles_of({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}).corners,
              ElementsAre(Triangle{0, 1, 2}, Triangle{3, 0, 2}));
  EXPECT_THAT(triangles_of(in_space({{0, 0}, {2, 0}, {3, 1}, {1, 2}, {-1, 1}}, Plane::tilted)).corners,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
}

TEST(Polygon, corners_on_an_edge_leave_the_fan) {
  EXPECT_THAT(triangles_of(in_space({{0, 0}, {.1, .1}, {.7, .7}, {1, 1}, {0, 2}}, Plane::z)).corners,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
}

TEST(Polygon, arrow_head) { expect_is_filled({{0, -.5}, {2, -1}, {0, 2.5}, {-2, -1}}); }

TEST(Polygon, letters) {
  expect_is_filled({{-2, -2}, {2, -2}, {2, -1}, {-1, -1}, {-1, 2}, {-2, 2}});
  expect_is_filled({{-2, -2},
                    {2, -2},
                    {2, 2},
                    {1, 2},
                    {1, -1},
                    {.5, -1},
                    {.5, 2},
                    {-.5, 2},
                    {-.5, -1},
                    {-1, -1},
                    {-1, 2},
                    {-2, 2}});
}

TEST(Polygon, star_with_corners_on_its_edges) {
  Flat star;
  for (int k = 0; k < 14; ++k) {
    const double angle = std::numbers::pi * k / 7, radius = k % 2 ? 1 : 2.7;
    star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  for (std::size_t k = star.size(); k > 0; k -= 2) {
    const auto &a = star[k - 1], &b = star[k % star.size()];
    star.insert(star.begin() + std::ptrdiff_t(k), {(a.x + b.x) / 2, (a.y + b.y) / 2});
  }
  expect_is_filled(star);
}

TEST(Polygon, spiral) {
  Flat spiral{{0, 0}};
  for (int k = 0; k <= 20; ++k) {
    const double angle = 2.6 * std::numbers::pi * k / 20, radius = .8 + .08 * k;
    spiral.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  for (int k = 20; k >= 1; --k) {
    const double angle = 2.6 * std::numbers::pi * k / 20, radius = .4 + .08 * k;
    spiral.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  expect_is_filled(spiral);
}

TEST(Polygon, holes_joined_to_the_outline) {
  expect_is_filled(
      {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}, {-2, -2}, {-1, -1}, {-1, 1}, {1, 1}, {1, -1}, {-1, -1}});
  expect_is_filled({{-2.5, -2.5},
                    {2.5, -2.5},
                    {2.5, 2.5},
                    {-2.5, 2.5},
                    {-2.5, -2.5},
                    {-2, -2},
                    {-2, -1},
                    {-1, -1},
                    {-1, -2},
                    {-2, -2},
                    {-2.5, -2.5},
                    {-2.5, 2.5},
                    {-1, 2},
                    {1, 2},
                    {0, 0},
                    {-1, 2},
                    {-2.5, 2.5}});
}

TEST(Polygon, outline_that_touches_itself_in_a_corner) {
  expect_is_filled({{-2, -2}, {0, -2}, {0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}, {-2, 0}});
}

TEST(Polygon, not_quite_flat) {
  const Flat flat{{-2, -2}, {2, -2}, {2, -1}, {-1, -1}, {-1, 2}, {-2, 2}};
  auto polygon = in_space(flat, Plane::z);
  for (std::size_t k = 0; k < polygon.size(); ++k) polygon[k].z += k % 2 ? .1 : -.1;
  const auto triangles = triangles_of(polygon);
  EXPECT_TRUE(triangles.is_simple && triangles.is_flat);
  expect_tiles(flat, triangles.corners);
}

TEST(Polygon, tells_what_crosses_itself_and_what_is_bent) {
  EXPECT_FALSE(triangles_of(in_space({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, Plane::z)).is_simple);
  EXPECT_FALSE(triangles_of(in_space({{0, 0}, {2, 2}, {2, 0}, {1, -1}, {0, 2}}, Plane::tilted)).is_simple);
  // Its fan has left turns only, but goes round its first corner more than once.
  EXPECT_FALSE(
      triangles_of(in_space({{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}, {2, 0}, {0, 2}}, Plane::x)).is_simple);
  EXPECT_FALSE(triangles_of({{0, 0, 0}, {2, 0, 0}, {3, 1, 2}, {1, 2, -1}, {-1, 1, 0}}).is_flat);
  EXPECT_TRUE(triangles_of({{0, 0, 0}, {1, 0, .3}, {1, 1, 0}, {0, 1, .3}}).is_simple);
}

TEST(Polygon, without_area_or_with_one_corner_again) {
  EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}).corners.size(), 3u);
  EXPECT_EQ(triangles_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).corners.size(), 3u);
  EXPECT_THAT(triangles_of(in_space({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}}, Plane::x)).corners,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
}

}  // namespace
}  // namespace etendue

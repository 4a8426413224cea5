// Triangles joined into convex polygons: which go together, and that the polygons are the triangles.
//
// Seen to fail when: a side that took in another keeps its end; the map of triangles is not joined; the
// normals, or the distances from the plane, or the areas are not compared; a right turn counts as a left one;
// nine corners are allowed; equal positions, or 0 and -0, are different vertices; of three planes any two are
// paired.
#include "geometry/convex_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <string>

namespace etendue {
namespace {

using Vec3d = Vec3<double>;

struct Triangles {
  std::vector<Vec3f> positions;
  std::vector<std::int32_t> indices;

  Vec3d corner(std::size_t triangle, std::size_t k) const {
    return widen(positions[std::size_t(indices[3 * triangle + k])]);
  }
  Vec3d vector_area(std::size_t triangle) const {
    return cross(corner(triangle, 1) - corner(triangle, 0), corner(triangle, 2) - corner(triangle, 0)) * 0.5;
  }
  std::size_t count() const { return indices.size() / 3; }
};

/// Each triangle lies in its polygon, faces as it does, and the areas add up: the polygons are the triangles.
void expect_partition(const Triangles& mesh, const ConvexPieces& pieces, double tolerance) {
  ASSERT_EQ(pieces.piece.size(), mesh.count());
  std::vector<double> area_of_triangles(std::size_t(pieces.count()), 0.0);
  for (std::size_t t = 0; t < mesh.count(); ++t) {
    ASSERT_GE(pieces.piece[t], 0);
    ASSERT_LT(pieces.piece[t], pieces.count());
    area_of_triangles[std::size_t(pieces.piece[t])] += length(mesh.vector_area(t));
  }
  for (std::int32_t piece = 0; piece < pieces.count(); ++piece) {
    const auto first = std::size_t(pieces.first_corner[std::size_t(piece)]);
    const std::size_t count = std::size_t(pieces.first_corner[std::size_t(piece) + 1]) - first;
    ASSERT_GE(count, 3u);
    ASSERT_LE(count, std::size_t(most_corners));
    const auto corner = [&](std::size_t k) { return widen(pieces.corners[first + k % count]); };
    Vec3d across{0, 0, 0};
    double size = 0;
    for (std::size_t k = 1; k + 1 < count; ++k) {
      across = across + cross(corner(k) - corner(0), corner(k + 1) - corner(0));
      size = std::max(size, length(corner(k + 1) - corner(0)));
    }
    EXPECT_NEAR(0.5 * length(across), area_of_triangles[std::size_t(piece)],
                2e-6 * area_of_triangles[std::size_t(piece)])
        << "polygon " << piece << " of " << count << " corners";
    if (!(length(across) > 0)) continue;
    const Vec3d normal = normalize(across);
    const auto off_side = [&](std::size_t k, const Vec3d& p) {
      const Vec3d along = corner(k + 1) - corner(k);
      return dot(cross(along, p - corner(k)), normal) / length(along);
    };
    for (std::size_t k = 0; k < count; ++k) EXPECT_GT(off_side(k, corner(k + 2)), 0) << "not convex";
    for (std::size_t t = 0; t < mesh.count(); ++t) {
      if (pieces.piece[t] != piece) continue;
      EXPECT_GE(dot(mesh.vector_area(t), normal), 0);
      for (const std::size_t k : {0u, 1u, 2u}) {
        EXPECT_NEAR(dot(mesh.corner(t, k) - corner(0), normal), 0, tolerance);
        for (std::size_t side = 0; side < count; ++side)
          EXPECT_GE(off_side(side, mesh.corner(t, k)), -tolerance);
      }
    }
  }
}

ConvexPieces pieces_of(const Triangles& mesh, double tolerance = 1e-5) {
  ConvexPieces pieces = convex_pieces(mesh.positions, mesh.indices);
  expect_partition(mesh, pieces, tolerance);
  return pieces;
}

/// Each square by two triangles over alternating diagonals.
Triangles grid(int columns, int rows) {
  Triangles mesh;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) mesh.positions.push_back({0.125f * float(x), 0.25f * float(y), 1});
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int a = y * (columns + 1) + x, b = a + 1, c = b + columns + 1, d = c - 1;
      const bool is_even = (x + y) % 2 == 0;
      const std::vector<int> both = is_even ? std::vector{a, b, c, a, c, d} : std::vector{a, b, d, b, c, d};
      mesh.indices.insert(mesh.indices.end(), both.begin(), both.end());
    }
  return mesh;
}

/// Rounds every position anew.
Triangles turned(Triangles mesh, float angle) {
  for (Vec3f& p : mesh.positions)
    p = {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle),
         p.z + 0.3f * p.x};
  return mesh;
}

TEST(ConvexPieces, AreOneForARectangleOfTwoTriangles) {
  const Triangles mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}};
  const ConvexPieces pieces = pieces_of(mesh);
  ASSERT_EQ(pieces.count(), 1);
  EXPECT_EQ(pieces.corners.size(), 4u);
}

TEST(ConvexPieces, AreOneForAFlatGridHoweverItIsTurned) {
  EXPECT_EQ(pieces_of(grid(20, 30)).count(), 1);
  for (const float angle : {0.3f, 1.7f, 4.0f}) EXPECT_LE(pieces_of(turned(grid(20, 30), angle)).count(), 300);
}

TEST(ConvexPieces, FindVerticesThatAreOnlyEqual) {
  Triangles apart;
  const Triangles mesh = grid(3, 3);
  for (const std::int32_t i : mesh.indices) {
    apart.indices.push_back(std::int32_t(apart.positions.size()));
    apart.positions.push_back(mesh.positions[std::size_t(i)]);
  }
  apart.positions[0].x = -0.0f;
  EXPECT_EQ(pieces_of(apart).count(), 1);
}

TEST(ConvexPieces, UseOnlyTheTrianglesThatAreNamed) {
  Triangles mesh = grid(4, 4);
  mesh.indices.erase(mesh.indices.begin(), mesh.indices.begin() + 3 * 24);
  EXPECT_EQ(pieces_of(mesh).count(), 1);
  mesh.indices.clear();
  EXPECT_EQ(convex_pieces(mesh.positions, mesh.indices).count(), 0);
}

TEST(ConvexPieces, KeepBentQuadsApart) {
  for (const float height : {1.0f, 0.1f, 0.01f, 0.002f, 3e-4f}) {
    const Triangles mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, height}, {0, 1, 0}}, {0, 1, 3, 1, 2, 3}};
    EXPECT_EQ(pieces_of(mesh).count(), 2) << height;
  }
}

TEST(ConvexPieces, OfACubeAreItsFaces) {
  Triangles mesh;
  for (int k = 0; k < 8; ++k) mesh.positions.push_back({float(k & 1), float(k >> 1 & 1), float(k >> 2)});
  for (const auto& [a, b, c, d] :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    for (const int i : {a, b, c, a, c, d}) mesh.indices.push_back(i);
  EXPECT_EQ(pieces_of(mesh).count(), 6);
}

TEST(ConvexPieces, CutConcaveOutlinesIntoConvexParts) {
  Triangles corner = grid(2, 2);
  corner.indices.resize(3 * 6);  // three squares around a corner
  EXPECT_EQ(pieces_of(corner).count(), 2);

  Triangles star;  // ten corners, five of them inward
  star.positions.push_back({0, 0, 0});
  for (int k = 0; k < 10; ++k) {
    const double angle = k * std::numbers::pi / 5, radius = k % 2 == 0 ? 1 : 0.4;
    star.positions.push_back({float(radius * std::cos(angle)), float(radius * std::sin(angle)), 0});
    for (const int i : {0, 1 + k, 1 + (k + 1) % 10}) star.indices.push_back(i);
  }
  EXPECT_LE(pieces_of(star).count(), 5);
}

TEST(ConvexPieces, HaveAtMostEightCorners) {
  for (const int spokes : {5, 8, 9, 64, 1000}) {
    Triangles fan;
    fan.positions.push_back({0, 0, 0});
    for (int k = 0; k < spokes; ++k) {
      const double angle = 2 * std::numbers::pi * k / spokes;
      fan.positions.push_back({float(std::cos(angle)), float(std::sin(angle)), 0});
      for (const int i : {0, 1 + k, 1 + (k + 1) % spokes}) fan.indices.push_back(i);
    }
    const int count = pieces_of(fan).count();
    if (spokes <= 8)
      EXPECT_LE(count, 3) << spokes;
    else
      EXPECT_LE(count, spokes / 3);
  }
}

TEST(ConvexPieces, JoinAcrossVerticesThatOnlyOneSideHas) {
  // Two squares; the left one's right side has a vertex in its middle.
  const Triangles mesh{{{0, 0, 0}, {1, 0, 0}, {1, 0.5f, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}},
                       {0, 1, 2, 0, 2, 4, 2, 3, 4, 1, 5, 6, 1, 6, 3}};
  EXPECT_EQ(pieces_of(mesh).count(), 1);
  // Where the other side is half as long, nothing fits.
  const Triangles half{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {1, 0.5f, 0}, {2, 0.5f, 0}},
                       {0, 1, 2, 0, 2, 3, 1, 4, 6, 1, 6, 5}};
  EXPECT_EQ(pieces_of(half).count(), 2);
}

TEST(ConvexPieces, KeepWhatFacesTheOtherWayApart) {
  const Triangles flipped{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 3, 2}};
  EXPECT_EQ(pieces_of(flipped).count(), 2);
  const Triangles back_to_back{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                               {0, 1, 2, 0, 2, 3, 0, 2, 1, 0, 3, 2}};
  EXPECT_EQ(pieces_of(back_to_back).count(), 2);
}

TEST(ConvexPieces, CountRepeatedTrianglesAsOftenAsTheyAreThere) {
  const Triangles twice{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                        {0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3, 1, 2, 0}};
  EXPECT_EQ(pieces_of(twice).count(), 3);
}

TEST(ConvexPieces, TakeTrianglesWithoutAreaAndSlivers) {
  const Triangles mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0, 0}, {0.5f, -1e-7f, 0}},
                       {0, 1, 2, 0, 2, 3, 0, 4, 1, 0, 0, 2, 0, 5, 1, 3, 3, 3}};
  const ConvexPieces pieces = pieces_of(mesh);
  EXPECT_EQ(pieces.piece[0], pieces.piece[1]);
}

TEST(ConvexPieces, KeepTheAreaOfWhatIsNoWiderThanRounding) {
  const float width = 1e-5f, bend = 2e-7f;
  const Triangles strip{{{0, 0, 0}, {1, -bend, 0}, {2, 0, 0}, {2, width, 0}, {1, width, 0}, {0, width, 0}},
                        {0, 1, 4, 0, 4, 5, 1, 2, 3, 1, 3, 4}};
  pieces_of(strip);
}

TEST(ConvexPieces, WhereThreePlanesMeetJoinThoseOfOne) {
  const Triangles mesh{{{0, 0, 0}, {0, 1, 0}, {1, 0.5f, 0}, {-1, 0.5f, 0}, {0, 0.5f, 1}},
                       {0, 1, 4, 1, 0, 2, 0, 1, 3}};
  const ConvexPieces pieces = pieces_of(mesh);
  EXPECT_EQ(pieces.count(), 2);
  EXPECT_EQ(pieces.piece[1], pieces.piece[2]);
}

TEST(ConvexPieces, LeaveAFineSphereAsItIs) {
  Triangles sphere;
  constexpr int rows = 60, columns = 120;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double theta = std::numbers::pi * y / rows, radius = y % rows == 0 ? 0 : std::sin(theta);
      const double phi = 2 * std::numbers::pi * x / columns;
      sphere.positions.push_back(
          {float(radius * std::cos(phi)), float(radius * std::sin(phi)), float(std::cos(theta))});
    }
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int a = y * columns + x, b = y * columns + (x + 1) % columns;
      for (const int i : {a, a + columns, b + columns, a, b + columns, b}) sphere.indices.push_back(i);
    }
  // Two triangles of one row make a flat trapezium; no more go together.
  EXPECT_GE(pieces_of(sphere).count(), rows * columns);
}

TEST(ConvexPieces, PartitionRandomFlatMeshes) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int trial = 0; trial < 20; ++trial) {
    // A grid whose inner vertices are moved, with some of its triangles left out.
    const int size = 2 + trial % 6;
    Triangles mesh = grid(size, size);
    for (Vec3f& p : mesh.positions) p = {p.x + 0.05f * unit(engine), p.y + 0.05f * unit(engine), 1};
    Triangles holed{mesh.positions, {}};
    for (std::size_t t = 0; t < mesh.count(); ++t)
      if (unit(engine) < 0.8f)
        holed.indices.insert(holed.indices.end(), mesh.indices.begin() + std::ptrdiff_t(3 * t),
                             mesh.indices.begin() + std::ptrdiff_t(3 * t + 3));
    const ConvexPieces pieces = pieces_of(turned(holed, unit(engine)));
    EXPECT_LT(pieces.count(), int(0.8 * double(holed.count()))) << trial;
  }
}

}  // namespace
}  // namespace etendue

// How the tables of a scene's shapes grow.
#include "geometry/geometry.h"

#include "geometry/shapes.h"

#include <cstddef>
#include <gtest/gtest.h>
#include <vector>

namespace etendue {
namespace {

TEST(Geometry, GrowsBySteps) {
  // Tables that grow to the size needed, and no further, are copied for each mesh.
  Geometry geometry;
  std::size_t steps = 0;
  std::vector<std::size_t> before(4);
  for (int i = 0; i < 10000; ++i) {
    geometry.add_mesh(make_rectangle({}), {0});
    const std::vector<std::size_t> now{geometry.positions.capacity(), geometry.normals.capacity(),
                                       geometry.uvs.capacity(), geometry.indices.capacity()};
    for (std::size_t k = 0; k < now.size(); ++k) steps += now[k] != before[k];
    before = now;
  }
  EXPECT_LT(steps, 100u);
}

TEST(Geometry, HoldsOneMeshWithoutRoomForMore) {
  Mesh mesh;
  mesh.positions.resize(30000);
  mesh.indices.resize(60000);
  Geometry geometry;
  geometry.add_mesh(mesh, {0});
  EXPECT_EQ(geometry.positions.capacity(), mesh.positions.size() + 1);
  EXPECT_EQ(geometry.normals.capacity(), mesh.positions.size());
  EXPECT_EQ(geometry.indices.capacity(), mesh.indices.size());
}

}  // namespace
}  // namespace etendue

// Vertices of paths: what is known of a place that a ray has come to.
#include "integrator/vertex.h"

#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "support/program.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// Shading normal at barycentric u, v of a triangle at z = 0 whose third vertex normal points down.
Vec3f shading_normal(float u, float v) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "m.obj",
                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 -1\nf 1//1 2//1 3//2\n");
  test::write_file(folder.path() / "s.xml",
                   "<scene><camera type='perspective'/><mesh type='obj'><string name='filename' "
                   "value='m.obj'/></mesh></scene>");
  const LoadedScene loaded = load_scene(read_nori_xml(folder.path() / "s.xml"));
  const HitNormals<float> normals(
      loaded.scene, {.t = 1, .barycentric = {u, v}, .ng = {0, 0, 1}, .geometry = 0, .primitive = 0}, true);
  EXPECT_EQ(normals.ng, (Vec3f{0, 0, 1}));
  return normals.ns;
}

TEST(HitNormals, AreInterpolated) {
  EXPECT_EQ(shading_normal(0.25f, 0.25f), (Vec3f{0, 0, 1}));
  EXPECT_EQ(shading_normal(0.125f, 0.75f), (Vec3f{0, 0, -1}));
}

TEST(HitNormals, AreGeometricWhereVertexNormalsCancel) {
  EXPECT_EQ(shading_normal(0.25f, 0.5f), (Vec3f{0, 0, 1}));
}

}  // namespace
}  // namespace etendue

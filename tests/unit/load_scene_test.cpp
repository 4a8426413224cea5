// Shapes and their materials, from a file to the scene's tables.
#include "scene/load_scene.h"

#include "scenefile/nori_xml.h"
#include "support/program.h"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace etendue {
namespace {

LoadedScene load_with(const std::string& shapes) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  test::write_file(folder.path() / "scene.xml",
                   "<scene><camera type='perspective'><integer name='width' value='4'/><integer "
                   "name='height' value='4'/></camera>" +
                       shapes + "</scene>");
  return load_scene(read_nori_xml(folder.path() / "scene.xml"));
}

std::string shape_with(const std::string& inside) { return "<shape type='rectangle'>" + inside + "</shape>"; }
std::string grey(double albedo) {
  return fmt::format("<bsdf type='diffuse'><color name='albedo' value='{}'/></bsdf>", albedo);
}
std::string checkers(const std::string& parameter, double dark) {
  return fmt::format(
      "<bsdf type='diffuse'><texture type='checkerboard_color' name='{}'><color name='value1' value='{}'/>"
      "</texture></bsdf>",
      parameter, dark);
}

std::vector<std::int32_t> materials_of(const std::string& shapes) {
  return load_with(shapes).scene.geometry.material;
}

TEST(Materials, AreSharedWhereTheirDescriptionsAreAlike) {
  const auto materials = materials_of(
      shape_with("") + shape_with(grey(0.3)) +
      "<mesh type='obj'><string name='filename' value='triangle.obj'/></mesh>" + "<shape type='sphere'>" +
      grey(0.3) + "</shape>" + shape_with(grey(0.4)) + shape_with("<bsdf type='mirror'/>") +
      shape_with(grey(0.3)) + shape_with("<bsdf type='mirror'/>") + shape_with(checkers("albedo", 0.1)) +
      shape_with(checkers("albedo", 0.2)) + shape_with(checkers("albedo", 0.1)));
  EXPECT_EQ(materials, (std::vector<std::int32_t>{0, 1, 0, 1, 2, 3, 1, 3, 4, 5, 4}));
}

TEST(Materials, ManyShapesHaveAsManyAsDiffer) {
  std::string shapes;
  for (int i = 0; i < 300; ++i) shapes += shape_with(i % 3 == 0 ? "" : grey(0.25 * (i % 3)));
  const LoadedScene loaded = load_with(shapes);
  EXPECT_EQ(loaded.scene.geometry.count(), 300);
  EXPECT_EQ(loaded.scene.materials.count(), 3);
}

TEST(Materials, WithUnknownKeysAreEachWarnedOf) {
  const std::string odd = shape_with("<bsdf type='mirror'><float name='shine' value='1'/></bsdf>");
  const LoadedScene loaded = load_with(odd + odd);
  EXPECT_EQ(loaded.warnings.size(), 2u);
}

/// `shapes`, read before their camera, which is at 1e16 m, where floats hold nothing.
LoadedScene load_far(const std::string& shapes) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  test::write_file(folder.path() / "scene.xml",
                   "<scene>" + shapes +
                       "<camera type='perspective'><transform name='toWorld'><translate value='1e16,0,0'/>"
                       "</transform></camera></scene>");
  return load_scene(read_nori_xml(folder.path() / "scene.xml"));
}

TEST(ScenesFarAway, AreReadNearTheirCamera) {
  const std::string there = "<transform name='toWorld'><translate value='1e16,0,3'/></transform>";
  const auto at_camera = [](const LoadedScene& loaded) {
    return std::abs(loaded.scene.origin.x - 1e16) < 100;
  };
  EXPECT_TRUE(at_camera(load_far("<shape type='rectangle'>" + there + "</shape>")));
  EXPECT_TRUE(at_camera(load_far("<shape type='disk'>" + there + "</shape>")));
  EXPECT_TRUE(at_camera(load_far("<shape type='sphere'>" + there + "</shape>")));
  const std::string mesh =
      "<mesh type='obj'><string name='filename' value='triangle.obj'/>" + there + "</mesh>";
  EXPECT_TRUE(at_camera(load_far(mesh)));
  EXPECT_TRUE(at_camera(load_far("<emitter type='point'>" + there + "</emitter>" + mesh)));
  EXPECT_TRUE(at_camera(load_far("<medium type='homogeneous'>" + there + "</medium>" + mesh)));
}

}  // namespace
}  // namespace etendue

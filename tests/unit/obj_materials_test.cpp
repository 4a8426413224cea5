// Meshes with the materials of their files: from the text to the scene's tables.
#include "scenefile/obj_materials.h"

#include "geometry/obj_reader.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "scenefile/scene_files.h"
#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Five triangles: one without a material, then `wall`, `lamp`, `wall` again and one of a material that no
/// library has.
const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\n";
const std::string obj = "mtllib rooms/a.mtl\nmtllib b.mtl\n" + corners +
                        "f 1 2 3\nusemtl wall\nf 2 4 3\nusemtl the lamp\nf 1 2 5\nusemtl wall\nf 1 3 5\n"
                        "usemtl none\nusemtl lost\nf 2 3 5\n";

class ObjMaterials : public testing::Test {
 protected:
  ObjMaterials() {
    std::filesystem::create_directories(folder_.path() / "m/rooms");
    write("m/rooms/a.mtl", "newmtl wall\nKd .25\n");
    write("m/b.mtl", "newmtl wall\nKd 1\nnewmtl the lamp\nKe 2 2 2\nKd 0\nnewmtl none\nKd 1\n");
    write("m/room.obj", obj);
  }
  void write(const std::string& name, const std::string& text) const {
    test::write_file(folder_.path() / name, text);
  }
  SceneDesc read(const std::string& inside, const std::string& keys = asked) const {
    write("s.xml",
          "<scene dialect='nori'><camera type='perspective'><integer name='width' value='2'/><integer "
          "name='height' value='2'/></camera><mesh type='obj'><string name='filename' value='m/room.obj'/>" +
              keys + inside + "</mesh></scene>");
    return read_nori_xml(folder_.path() / "s.xml");
  }
  LoadedScene load(const std::string& inside, const std::string& keys = asked) const {
    return load_scene(read(inside, keys));
  }
  static float albedo(const LoadedScene& loaded, int shape) {
    const Material& material = loaded.scene.materials[loaded.scene.geometry.material[std::size_t(shape)]];
    return std::get<Colorf>(std::get<Diffuse>(material).albedo).r;
  }

  static constexpr const char* asked = "<boolean name='materials' value='true'/>";
  const test::TemporaryFolder folder_;
};

TEST_F(ObjMaterials, EachIsAShapeOfItsOwn) {
  const LoadedScene loaded = load("<bsdf type='diffuse'><color name='albedo' value='.125'/></bsdf>");
  const Geometry& geometry = loaded.scene.geometry;
  ASSERT_EQ(geometry.count(), 4);
  EXPECT_THAT(geometry.triangles, ElementsAre(1, 2, 1, 1));
  EXPECT_EQ(albedo(loaded, 0), 0.125f);
  EXPECT_EQ(albedo(loaded, 1), 0.25f);  // The first library that has it counts.
  EXPECT_EQ(albedo(loaded, 2), 0);
  EXPECT_EQ(albedo(loaded, 3), 0.125f);
  EXPECT_EQ(loaded.scene.lights.count(), 1);
  EXPECT_EQ(loaded.places.shapes[2].name, "obj 'room the lamp'");
  EXPECT_EQ(geometry.light[2], 0);
  EXPECT_EQ(geometry.light[1], -1);
  EXPECT_THAT(loaded.warnings,
              ElementsAre(AllOf(HasSubstr("room.obj:16:8"), HasSubstr("has the material 'lost'"))));
}

TEST_F(ObjMaterials, AreNotReadUnlessAskedFor) {
  const LoadedScene loaded = load("", "");
  EXPECT_EQ(loaded.scene.geometry.count(), 1);
  EXPECT_EQ(loaded.scene.lights.count(), 0);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("name=\"materials\" value=\"true\"")));
}

TEST_F(ObjMaterials, UsemtlTakesTheFacesOfOne) {
  const LoadedScene loaded = load("<emitter type='area'/>", "<string name='usemtl' value='wall'/>");
  EXPECT_EQ(loaded.scene.geometry.count(), 1);
  EXPECT_THAT(loaded.scene.geometry.triangles, ElementsAre(2));
  EXPECT_EQ(loaded.scene.lights.count(), 1);
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_EQ(albedo(load("", std::string(asked) + "<string name='usemtl' value='wall'/>"), 0), 0.25f);
  EXPECT_THAT(test::error_of([&] { load("", "<string name='usemtl' value='wal'/>"); }),
              AllOf(HasSubstr("no face has the material 'wal'"), HasSubstr("did you mean 'wall'?")));
  EXPECT_THAT(test::error_of([&] { load("", "<string name='usemtl' value='none'/>"); }),
              HasSubstr("no face has the material 'none'"));
}

TEST_F(ObjMaterials, ABsdfThatNoFaceNeedsIsTold) {
  write("m/room.obj", "mtllib b.mtl\n" + corners + "usemtl wall\nf 1 2 3\n");
  EXPECT_THAT(load("<bsdf type='mirror'/>").warnings,
              ElementsAre(HasSubstr("this has no effect: all faces of 'm/room.obj' have a material")));
}

TEST_F(ObjMaterials, LibrariesAndTexturesAreFilesOfTheScene) {
  write("m/rooms/wood.exr", "1");
  write("m/rooms/a.mtl", "newmtl wall\nmap_Kd wood.exr\n");
  const SceneDesc scene = read("");
  EXPECT_EQ(files_named_by(scene),
            (std::vector{folder_.path() / "m/room.obj", folder_.path() / "m/rooms/wood.exr",
                         folder_.path() / "m/rooms/a.mtl", folder_.path() / "m/b.mtl"}));
  const std::uint64_t before = scene_hash(scene);
  write("m/b.mtl", "newmtl the lamp\nKe 2 2 3\n");
  EXPECT_NE(scene_hash(read("")), before);
}

TEST_F(ObjMaterials, LibraryNamesMayHoldBlanks) {
  write("m/two words.mtl", "newmtl wall\nKd .75\n");
  write("m/room.obj", "mtllib two words.mtl\n" + corners + "usemtl wall\nf 1 2 3\n");
  EXPECT_EQ(albedo(load(""), 0), 0.75f);
  write("m/room.obj", "mtllib b.mtl rooms/a.mtl\n" + corners + "usemtl wall\nf 1 2 3\n");
  EXPECT_EQ(albedo(load(""), 0), 1);
}

TEST_F(ObjMaterials, ErrorsTellWhere) {
  write("m/room.obj", corners + "usemtl wall\nf 1 2 3\n");
  EXPECT_THAT(test::error_of([&] { load(""); }),
              AllOf(HasSubstr("s.xml:1:"), HasSubstr("'m/room.obj' names no library of materials")));
  write("m/room.obj", "mtllib B.mtl\n" + corners + "usemtl wall\nf 1 2 3\n");
  EXPECT_THAT(test::error_of([&] { load(""); }),
              AllOf(HasSubstr("room.obj:1:8: 'B.mtl' is not there"), HasSubstr("did you mean 'b.mtl'?")));
}

TEST_F(ObjMaterials, FaultsOfAPartPointAtItsOwnFaces) {
  write("m/room.obj",
        "mtllib b.mtl\n" + corners + "f 1 2 3\nusemtl wall\nf 1 1 2\nf 1 2 3\nusemtl none\nf 3 3 1\n");
  EXPECT_THAT(test::error_of([&] { load(""); }), HasSubstr("room.obj:12:1: no triangle has an area"));
}

TEST_F(ObjMaterials, PlacesInMessagesAreThoseOfTheFile) {
  write("m/room.obj", "mtllib b.mtl\n" + corners +
                          "v 1e39 0 0\nv 2 0 0\nvn 0 0 1\nvn 0 0 0\n"
                          "usemtl wall\nf 1 2 3\nusemtl none\nf 2//1 3//1 5//2\nusemtl the lamp\nf 7 6 1\n");
  const auto error_with = [&](const std::string& material) {
    return test::error_of([&] { load("", "<string name='usemtl' value='" + material + "'/>"); });
  };
  EXPECT_EQ(error_with("wall"), "");
  EXPECT_THAT(error_with("none"), HasSubstr("room.obj:10:1: normal 2 "));
  EXPECT_THAT(error_with("the lamp"), HasSubstr("room.obj:7:3: vertex 6: "));
}

TEST_F(ObjMaterials, PartsTogetherAreTheWhole) {
  std::string text = "mtllib b.mtl\n";
  for (int i = 0; i < 30; ++i)
    text += fmt::format("v {} {} {}\nvt {} .5\nvn 0 {} 1\n", i % 7, i % 5, i % 3, .01 * i, .02 * i);
  for (int i = 1; i <= 28; ++i)
    text += fmt::format("usemtl m{0}\nf {1}/{2}/{1} {2}/{1}/{3} {3}/{3}/{2}\n", i % 3, i, i + 1, i + 2);
  write("m/room.obj", text);
  const MeshFile file = read_obj_file(folder_.path() / "m/room.obj");
  const auto triangles_of = [&](const std::optional<std::string>& usemtl) {
    const Mesh mesh = file(translation({1, 2, 3}), usemtl);
    std::vector<std::string> triangles;
    for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
      const std::size_t v = mesh.indices[k];
      const Vec3f &p = mesh.positions[v], &n = mesh.normals[v];
      if (k % 3 == 0) triangles.emplace_back();
      triangles.back() +=
          fmt::format("{} {} {} {} {} {}, ", p.x, p.y, p.z, n.y, mesh.uvs[v].x, mesh.uvs[v].y);
    }
    return triangles;
  };
  std::vector<std::string> parts;
  for (const char* material : {"m0", "m1", "m2"})
    for (const std::string& triangle : triangles_of(material)) parts.push_back(triangle);
  EXPECT_THAT(parts, testing::UnorderedElementsAreArray(triangles_of(std::nullopt)));
}

TEST_F(ObjMaterials, KeysOfTheWrongTypeAreRefusedAsEver) {
  EXPECT_THAT(test::error_of([&] { load("", "<string name='materials' value='true'/>"); }),
              HasSubstr("'materials' of mesh 'obj' must be true or false"));
}

}  // namespace
}  // namespace etendue

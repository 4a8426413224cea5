#include "scenefile/scene_files.h"

#include "scenefile/nori_xml.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

class SceneFiles : public testing::Test {
 protected:
  SceneFiles() {
    write("a.obj", "v 0 0 0\n");
    write("b.exr", std::string("a\0b", 3));
    write("scene.xml", scene);
  }
  void write(const std::string& name, const std::string& text) const {
    test::write_file(folder_.path() / name, text);
  }
  std::uint64_t hash() const { return scene_hash(read_nori_xml(folder_.path() / "scene.xml")); }

  const std::string scene =
      "<scene><mesh type='obj'><string name='filename' value='a.obj'/></mesh>\n<mesh type='obj'>"
      "<string name='filename' value='a.obj'/></mesh><emitter type='envmap'>"
      "<string name='filename' value='b.exr'/></emitter></scene>";
  const test::TemporaryFolder folder_;
};

TEST_F(SceneFiles, AreNamedOnceInOrder) {
  const std::vector<std::filesystem::path> files =
      files_named_by(read_nori_xml(folder_.path() / "scene.xml"));
  EXPECT_EQ(files, (std::vector{folder_.path() / "a.obj", folder_.path() / "b.exr"}));
}

TEST_F(SceneFiles, HashIsOfTheContentOfAll) {
  const std::uint64_t before = hash();
  EXPECT_EQ(hash(), before);
  write("a.obj", "v 0 0 1\n");
  const std::uint64_t other_mesh = hash();
  EXPECT_NE(other_mesh, before);
  write("a.obj", "v 0 0 0\n");
  EXPECT_EQ(hash(), before);
  write("b.exr", std::string("a\0c", 3));
  EXPECT_NE(hash(), before);
  // The same bytes, cut elsewhere.
  write("a.obj", "v 0 0 0\na");
  write("b.exr", std::string("\0b", 2));
  EXPECT_NE(hash(), before);
  write("a.obj", "v 0 0 0\n");
  write("b.exr", std::string("a\0b", 3));
  write("scene.xml", scene + "\n");
  EXPECT_NE(hash(), before);
  write("scene.xml", scene);
  EXPECT_EQ(hash(), before);
}

TEST_F(SceneFiles, HashIsOfTheDialect) {
  const auto hash_as = [&](Dialect dialect) {
    return scene_hash(read_nori_xml(folder_.path() / "scene.xml", dialect));
  };
  EXPECT_EQ(hash_as(Dialect::nori), hash());
  EXPECT_NE(hash_as(Dialect::nori_eth), hash());
  EXPECT_NE(hash_as(Dialect::nori_2012), hash());
  EXPECT_NE(hash_as(Dialect::nori_2012), hash_as(Dialect::nori_eth));
}

}  // namespace
}  // namespace etendue

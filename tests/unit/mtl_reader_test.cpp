#include "scenefile/mtl_reader.h"

#include "base/error.h"
#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MtlReader : public testing::Test {
 protected:
  MtlLibrary read(const std::string& text) const {
    test::write_file(folder_.path() / "m.mtl", text);
    return read_mtl(folder_.path(), "m.mtl");
  }
  std::string error(const std::string& text) const {
    return test::error_of([&] { read(text); });
  }
  static Colorf color(const Object& object, const std::string& name) {
    for (const Property& property : object.properties)
      if (property.name == name) return std::get<Colorf>(property.value);
    ADD_FAILURE() << object.type << " has no " << name;
    return {};
  }

  const test::TemporaryFolder folder_;
};

TEST_F(MtlReader, KdAloneIsDiffuse) {
  const MtlLibrary library = read("# by hand\nnewmtl red wall\n\tKd .7 0.2 1e-1 # warm\nKs 0 0 0\nNs 10\n");
  ASSERT_EQ(library.materials.size(), 1u);
  EXPECT_EQ(library.materials[0].name, "red wall");
  EXPECT_EQ(library.materials[0].bsdf.type, "diffuse");
  EXPECT_EQ(color(library.materials[0].bsdf, "albedo"), (Colorf{0.7f, 0.2f, 0.1f}));
  EXPECT_FALSE(library.materials[0].emitter);
  EXPECT_THAT(library.warnings, IsEmpty());
}

TEST_F(MtlReader, KsAndNsArePhongUnlessIllumSaysNo) {
  const MtlLibrary library =
      read("newmtl a\nillum 2\nKd .2\nKs .3 .2 .1\nNs 40\nnewmtl b\nKd .2\nKs .3\nNs 40\nillum 1\n");
  const Object& phong = library.materials[0].bsdf;
  EXPECT_EQ(phong.type, "phong");
  EXPECT_EQ(color(phong, "diffuseReflectance"), (Colorf{0.2f, 0.2f, 0.2f}));
  EXPECT_EQ(color(phong, "specularReflectance"), (Colorf{0.3f, 0.2f, 0.1f}));
  EXPECT_EQ(phong.properties.back().name, "exponent");
  EXPECT_EQ(std::get<double>(phong.properties.back().value), 40);
  EXPECT_EQ(library.materials[1].bsdf.type, "diffuse");
  EXPECT_THAT(library.warnings, IsEmpty());
}

TEST_F(MtlReader, KeIsAnAreaLight) {
  const MtlLibrary library = read("newmtl a\nKe 3 2 1\nnewmtl b\nKe 0 0 0\nKd .4\n");
  ASSERT_TRUE(library.materials[0].emitter);
  EXPECT_EQ(library.materials[0].emitter->type, "area");
  EXPECT_EQ(color(*library.materials[0].emitter, "radiance"), (Colorf{3, 2, 1}));
  EXPECT_EQ(color(library.materials[0].bsdf, "albedo"), (Colorf{0, 0, 0}));
  EXPECT_FALSE(library.materials[1].emitter);
}

TEST_F(MtlReader, MapKdIsATextureOfTheLibrarysFolder) {
  std::filesystem::create_directories(folder_.path() / "lib/tex");
  test::write_file(folder_.path() / "lib/tex/two words.png", "");
  test::write_file(folder_.path() / "lib/m.mtl",
                   "newmtl a\nmap_Kd -s 1 1 1 -o 0 0 -clamp on tex/two words.png\n");
  const MtlLibrary library = read_mtl(folder_.path(), "lib/m.mtl");
  const Object& bsdf = library.materials[0].bsdf;
  ASSERT_EQ(bsdf.children.size(), 1u);
  EXPECT_EQ(bsdf.children[0].name, "albedo");
  EXPECT_EQ(std::get<std::string>(bsdf.children[0].properties[0].value), "lib/tex/two words.png");
  EXPECT_EQ(std::get<std::string>(bsdf.children[0].properties[1].value), "clamp");
  EXPECT_THAT(library.warnings, IsEmpty());
}

TEST_F(MtlReader, WhatIsRenderedOtherwiseIsToldOnceAFile) {
  test::write_file(folder_.path() / "t.png", "");
  EXPECT_THAT(read("newmtl a\nKd 1\nPr .5\nmap_Bump -bm .1 x.png\nnewmtl b\nKa 1 1 1\nNi 1\nPr 1\n").warnings,
              ElementsAre(AllOf(HasSubstr("m.mtl:3:1"), HasSubstr("Pr, map_Bump\n"))));
  EXPECT_THAT(read("newmtl a\nd 0.5\nnewmtl b\nTr 0.5\nnewmtl c\nd 1\nTr 0\n").warnings,
              ElementsAre(AllOf(HasSubstr("m.mtl:2:3"), HasSubstr("opaque (2 times)"))));
  EXPECT_THAT(read("newmtl a\nillum 7\n").warnings, ElementsAre(HasSubstr("illum above 2")));
  EXPECT_THAT(read("newmtl a\nKd .8\nKs .5\n").warnings, ElementsAre(HasSubstr("add up to more than 1")));
  EXPECT_THAT(read("newmtl a\nKd .5\nnewmtl a\nKd .6\n").warnings, ElementsAre(HasSubstr("m.mtl:3:8")));
  EXPECT_THAT(read("newmtl a\nKd .8\nKs .5\nmap_Kd -s 2 2 t.png\n").warnings,
              ElementsAre(HasSubstr("options of map_Kd"), HasSubstr("Ks is passed over"),
                          HasSubstr("the place of this Kd")));
}

TEST_F(MtlReader, ErrorsPointIntoTheFile) {
  EXPECT_THAT(error("newmtl a\nKd 1 x 1\n"), HasSubstr("m.mtl:2:6: 'x' is not a number"));
  EXPECT_THAT(error("newmtl a\nKd 1 1\n"), HasSubstr("m.mtl:2"));
  EXPECT_THAT(error("newmtl a\nKe\n"), HasSubstr("m.mtl:2"));
  EXPECT_THAT(error("newmtl a\nKe 1 -2 3\n"), HasSubstr("m.mtl:2:4: a colour is negative"));
  EXPECT_THAT(error("newmtl a\nKd 1e39\n"), HasSubstr("m.mtl:2:4"));
  EXPECT_THAT(error("newmtl a\nKd xyz 1 1 1\n"), HasSubstr("m.mtl:2:4: colours by 'xyz'"));
  EXPECT_THAT(error("newmtl a\nKs 1\nNs -2\n"), HasSubstr("m.mtl:3:4: Ns is -2"));
  EXPECT_THAT(error("newmtl a\nillum two\n"), HasSubstr("m.mtl:2:7"));
  EXPECT_THAT(error("newmtl\nKd 1\n"), HasSubstr("m.mtl:1:1: this material has no name"));
  EXPECT_THAT(error("Kd 1 1 1\n"), HasSubstr("m.mtl:1:1: 'Kd' belongs to no material"));
  EXPECT_THAT(error("newmtl a\nmap_Kd -clamp on\n"), HasSubstr("m.mtl:2:17: map_Kd names no image"));
  EXPECT_THAT(error("newmtl a\nmap_Kd T.png\n"), HasSubstr("m.mtl:2:8: 'T.png' is not there"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("no material"));
  EXPECT_THAT(error(""), HasSubstr("no material"));
  EXPECT_THAT(error("v 0 0 0\n"), HasSubstr("this is an OBJ mesh"));
  EXPECT_THAT(error(std::string("newmtl a\0\n", 10)), HasSubstr("this is no text"));
}

}  // namespace
}  // namespace etendue

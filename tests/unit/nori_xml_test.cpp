#include "scenefile/nori_xml.h"

#include "scenefile/text_file.h"
#include "support/data_folder.h"

#include <cstdlib>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

/// A folder of this test's own, removed behind it.
class NoriXml : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string pattern =
        (fs::temp_directory_path() / (std::string("etendue_") + info->name() + "_XXXXXX")).string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override { fs::remove_all(directory_); }

  fs::path write(const std::string& text) const {
    const fs::path file = directory_ / "s.xml";
    fs::remove(file);  // Some file systems wait for the disk where a file is written over.
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  SceneDesc read(const std::string& text) const { return read_nori_xml(write(text)); }

  /// What the error says, its folder left out; "" where there is none.
  std::string error(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& e) {
      const std::string message = e.what(), prefix = directory_.string() + "/";
      EXPECT_THAT(message, StartsWith(prefix));
      return message.substr(prefix.size());
    }
    return {};
  }

  Property::Value value(const std::string& element) const {
    return read("<scene>" + element + "</scene>").root.properties.at(0).value;
  }

  fs::path directory_;
};

/// The text a Location underlines.
std::string underlined(const Location& where) {
  return where.source->text.substr(where.offset, where.length);
}

TEST_F(NoriXml, ReadsTheTreeInFileOrderWithPlaces) {
  const SceneDesc scene = read(R"(
<?xml version="1.0" encoding="utf-8"?>
<!-- a comment with <tags> & "quotes" -->
<scene>
  <integrator type="path"/>
  <mesh type='obj' name = "the > floor">
    <string name="filename" value="a&amp;b.obj"/>
    <bsdf type="diffuse"><color name="albedo" value="0.5 0.25,1"/></bsdf>
  </mesh>
</scene>
)");
  EXPECT_EQ(scene.root.family, "scene");
  EXPECT_EQ(scene.root.type, "");
  EXPECT_EQ(scene.directory, directory_);
  ASSERT_EQ(scene.root.children.size(), 2u);
  const Object& mesh = scene.root.children[1];
  EXPECT_EQ(mesh.family, "mesh");
  EXPECT_EQ(mesh.type, "obj");
  EXPECT_EQ(mesh.name, "the > floor");
  EXPECT_EQ(underlined(mesh.location), "mesh");
  EXPECT_EQ(underlined(mesh.type_location), "obj");
  EXPECT_EQ(line_and_column(mesh.type_location).line, 6u);
  EXPECT_EQ(line_and_column(mesh.type_location).column, 15u);
  EXPECT_EQ(std::get<std::string>(mesh.properties.at(0).value), "a&b.obj");
  EXPECT_EQ(underlined(mesh.properties[0].name_location), "filename");
  EXPECT_EQ(underlined(mesh.properties[0].value_location), "a&amp;b.obj");
  const Property& albedo = mesh.children.at(0).properties.at(0);
  EXPECT_EQ(albedo.name, "albedo");
  EXPECT_EQ(albedo.tag, "color");
  EXPECT_EQ(std::get<Colorf>(albedo.value), (Colorf{0.5f, 0.25f, 1}));
  EXPECT_EQ(underlined(albedo.value_location), "0.5 0.25,1");
}

TEST_F(NoriXml, ReadsEveryTypeOfValue) {
  EXPECT_TRUE(std::get<bool>(value("<boolean name='a' value=' TRUE '/>")));
  EXPECT_FALSE(std::get<bool>(value("<boolean name='a' value='false'/>")));
  EXPECT_EQ(std::get<int>(value("<integer name='a' value='-12'/>")), -12);
  EXPECT_EQ(std::get<double>(value("<float name='a' value='+1.5e-3'/>")), 1.5e-3);
  EXPECT_EQ(std::get<double>(value("<float name='a' value='.5'/>")), 0.5);
  EXPECT_EQ(std::get<double>(value("<float name='a' value='&#49;'/>")), 1);
  EXPECT_EQ(std::get<std::string>(value("<string name='a' value='1\r\n 2'/>")), "1  2");
  EXPECT_EQ(std::get<std::string>(value("<string name='a' value=''/>")), "");
  EXPECT_EQ(std::get<Colorf>(value("<color name='a' value='0.5'/>")), (Colorf{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(std::get<Vec3<double>>(value("<point name='a' value='1,\r\n\t2 ,3,'/>")),
            (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(std::get<Vec2<double>>(value("<vector name='a' value='1 2'/>")), (Vec2<double>{1, 2}));
}

TEST_F(NoriXml, WhatIsWrittenLaterInATransformActsLater) {
  const auto transform = [&](const std::string& inside) {
    return std::get<Transform>(value("<transform name='toWorld'>" + inside + "</transform>"));
  };
  EXPECT_EQ(transform(""), Transform{});
  EXPECT_EQ(transform("<scale value='2'/><translate value='1,2,3'/>"),
            translation({1, 2, 3}) * scaling({2, 2, 2}));
  EXPECT_EQ(transform("<translate value='1 2 3'/><scale value='-1,1,1'/>"),
            scaling({-1, 1, 1}) * translation({1, 2, 3}));
  EXPECT_EQ(transform("<rotate axis='0 1 0' angle='30'/>"), rotation({0, 1, 0}, 30));
  EXPECT_EQ(transform("<lookat target='0,0,0' origin='4 5 6' up='0 1 0'/>"),
            look_at({4, 5, 6}, {0, 0, 0}, {0, 1, 0}));
  EXPECT_EQ(transform("<lookAt target='0,0,0' origin='4 5 6' up='0 1 0'/>"),
            look_at({4, 5, 6}, {0, 0, 0}, {0, 1, 0}));
  const Transform rows{{{{1, 2, 0, 4}, {0, 1, 0, 8}, {0, 0, 1, 12}, {0, 0, 0, 1}}}};
  EXPECT_EQ(transform("<matrix value='1 2 0 4 0 1 0 8 0 0 1 12 0 0 0 1'/>"), rows);
  EXPECT_EQ(std::get<Transform>(value("<transform name='a' value='1,2,0,4; 0,1,0,8; 0,0,1,12; 0,0,0,1;'/>")),
            rows);
}

TEST_F(NoriXml, PointsAtTheWrongToken) {
  EXPECT_EQ(error("<scene>\n  <float name=\"fov\" value=\"1.5abc\"/>\n</scene>"),
            "s.xml:2:28: '1.5abc' is not a number\n"
            "  2 |   <float name=\"fov\" value=\"1.5abc\"/>\n"
            "    |                            ^~~~~~");
  EXPECT_THAT(error("<scene><point name='a' value='1, 2,\r\n x'/></scene>"),
              StartsWith("s.xml:2:2: 'x' is not a number"));
  EXPECT_THAT(error("<scene><point name='a' value='1 2 3 4'/></scene>"),
              StartsWith("s.xml:1:37: expected 2 or 3 numbers, found 4"));
  EXPECT_THAT(error("<scene><color name='a' value='1 2'/></scene>"),
              StartsWith("s.xml:1:31: expected 1 or 3 numbers, found 2"));
  EXPECT_THAT(error("<scene><color name='a' value='1,,2'/></scene>"),
              StartsWith("s.xml:1:33: a number is missing before this comma"));
  EXPECT_THAT(error("<scene><transform name='a'><scale value='1 1 q'/></transform></scene>"),
              StartsWith("s.xml:1:46: 'q' is not a number"));
}

TEST_F(NoriXml, NumbersTooSmallForADoubleAreZero) {
  EXPECT_EQ(std::get<double>(value("<float name='a' value='-1e-400'/>")), 0);
  EXPECT_EQ(std::get<double>(value("<float name='a' value='4e-320'/>")), 4e-320);
  EXPECT_EQ(std::get<Colorf>(value("<color name='a' value='0.000e-99999, 1, 1'/>")), (Colorf{0, 1, 1}));
}

TEST_F(NoriXml, RefusesNumbersThatAreNoneOrNotFinite) {
  for (const char* number : {"nan", "inf", "-Infinity", "1e999", "0x10", "1.5f", "1e", "--1", "+-1", "", " ",
                             "1 2", "1;2", "&bomb;"})
    EXPECT_NE(error(std::string("<scene><float name='a' value='") + number + "'/></scene>"), "") << number;
  for (const char* number : {"1.0", "2147483648", "1e3", "", "0x1"})
    EXPECT_NE(error(std::string("<scene><integer name='a' value='") + number + "'/></scene>"), "") << number;
  EXPECT_THAT(error("<scene><float name='a' value='nan'/></scene>"),
              HasSubstr("'nan' is not a finite number"));
  EXPECT_THAT(error("<scene><integer name='a' value='2147483648'/></scene>"),
              HasSubstr("out of range for an integer"));
  EXPECT_THAT(error("<scene><color name='a' value='1e39'/></scene>"),
              HasSubstr("out of range for a 32-bit float"));
  EXPECT_THAT(error("<scene><boolean name='a' value='yes'/></scene>"),
              HasSubstr("neither 'true' nor 'false'"));
}

TEST_F(NoriXml, NamesUnknownAndMissingThings) {
  EXPECT_THAT(error("<scene><bsfd/></scene>"), HasSubstr("1:9: unknown tag <bsfd>"));
  EXPECT_THAT(error("<scene><bsfd/></scene>"), HasSubstr("did you mean 'bsdf'?"));
  EXPECT_THAT(error("<scene><mesh/></scene>"), StartsWith("s.xml:1:9: <mesh> lacks the attribute 'type'"));
  EXPECT_THAT(error("<scene><mesh type=''/></scene>"), HasSubstr("the type of <mesh> is empty"));
  EXPECT_THAT(error("<scene><float value='1'/></scene>"),
              StartsWith("s.xml:1:9: <float> lacks the attribute 'name'"));
  EXPECT_THAT(error("<scene><float name='a'/></scene>"), HasSubstr("<float> lacks the attribute 'value'"));
  EXPECT_THAT(error("<scene><float name='' value='1'/></scene>"), HasSubstr("the name of <float> is empty"));
  EXPECT_THAT(error("<scene><float name='a' vlaue='1'/></scene>"),
              StartsWith("s.xml:1:24: unknown attribute 'vlaue' of <float>"));
  EXPECT_THAT(error("<scene><float name='a' vlaue='1'/></scene>"), HasSubstr("did you mean 'value'?"));
  EXPECT_THAT(error("<scene><float name='a' value='1' value='2'/></scene>"),
              HasSubstr("'value' is given twice"));
  EXPECT_THAT(error("<scene version='3.0.0'/>"), HasSubstr("Mitsuba"));
  EXPECT_THAT(error("<mesh type='obj'/>"), HasSubstr("expected <scene> or <test>"));
  EXPECT_THAT(error("<test/>"), HasSubstr("<test> lacks the attribute 'type'"));
}

TEST_F(NoriXml, RefusesWhatStandsInTheWrongPlace) {
  EXPECT_THAT(error("<scene>\n  some text\n</scene>"), StartsWith("s.xml:2:3: text inside <scene>"));
  EXPECT_THAT(error("<scene><![CDATA[text]]></scene>"), HasSubstr("text inside <scene>"));
  EXPECT_THAT(error("<scene/>\ngarbage"), StartsWith("s.xml:2:1: text outside of the root element"));
  EXPECT_THAT(error("<scene/><scene/>"), StartsWith("s.xml:1:10: a second root element"));
  EXPECT_THAT(error("<scene><float name='a' value='1'><scale value='1'/></float></scene>"),
              StartsWith("s.xml:1:35: <scale> inside <float>"));
  EXPECT_THAT(error("<scene><scale value='1'/></scene>"),
              HasSubstr("<scale> may stand only inside <transform>"));
  EXPECT_THAT(error("<scene><transform name='t'><scael value='1'/></transform></scene>"),
              HasSubstr("did you mean 'scale'?"));
  EXPECT_THAT(error("<scene>\n<float name='a' value='1'/>\n<integer name='a' value='1'/></scene>"),
              StartsWith("s.xml:3:16: 'a' is stated twice in this <scene>, first in line 2"));
  EXPECT_THAT(error("<scene><transform name='t' value='1'><scale value='1'/></transform></scene>"),
              HasSubstr("not both"));
}

TEST_F(NoriXml, RefusesTransformsWithoutInverse) {
  const auto message = [&](const std::string& inside) {
    return error("<scene><transform name='t'>" + inside + "</transform></scene>");
  };
  EXPECT_THAT(message("<scale value='1 0 1'/>"), HasSubstr("a scale factor is 0"));
  EXPECT_THAT(message("<rotate axis='0 0 0' angle='1'/>"), HasSubstr("axis of a rotation has length 0"));
  EXPECT_THAT(message("<lookat origin='1 1 1' target='1 1 1' up='0 1 0'/>"), HasSubstr("the same point"));
  EXPECT_THAT(message("<lookat origin='0 0 0' target='0 1 0' up='0 2 0'/>"), HasSubstr("parallel"));
  EXPECT_THAT(message("<matrix value='1 1 0 0 1 1 0 0 0 0 1 0 0 0 0 1'/>"), HasSubstr("cannot be inverted"));
  EXPECT_THAT(message("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1'/>"), HasSubstr("not 0 0 0 1"));
  EXPECT_THAT(message("<matrix value='1 0 0 0; 0 1 0 0; 0 0 1 0'/>"), HasSubstr("found 3"));
  EXPECT_THAT(message("<matrix value='1 0 0 0; 0 1 0; 0 0 1 0; 0 0 0 1'/>"),
              HasSubstr("expected 4 numbers, found 3"));
  EXPECT_THAT(message("<scale value='1e200'/><scale value='1e200'/>"), HasSubstr("cannot be inverted"));
}

TEST_F(NoriXml, TellsWhereXmlIsBroken) {
  EXPECT_EQ(error("<scene>\n  <mesh type='obj'>\n</scene>"),
            "s.xml:3:3: expected </mesh>, the end of the element of line 2\n  3 | </scene>\n    |   ^");
  EXPECT_THAT(error("<?a <b> ?><scene><!-- <c> -->\n <mesh type='a>b'/>\n<bsdf type='x'></bsdf>\n"),
              StartsWith("s.xml:3:23: expected </scene>, the end of the element of line 1"));
  EXPECT_THAT(error("<scene>\n  <mesh type='obj"), StartsWith("s.xml:2:"));
  EXPECT_THAT(error("<scene><mesh type=obj/></scene>"), HasSubstr("not well-formed XML"));
  EXPECT_THAT(error("hello"), HasSubstr("s.xml:1:1: text outside"));
  EXPECT_THAT(error("<!-- nothing -->"), HasSubstr("the file has no element"));
  EXPECT_THAT(error("   \n"), HasSubstr("the file has no element"));
  EXPECT_EQ(error(""), "s.xml: the file is empty");
}

TEST_F(NoriXml, RefusesDocumentTypes) {
  EXPECT_THAT(error("<!DOCTYPE s [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n<scene/>"),
              HasSubstr("DOCTYPE"));
  EXPECT_THAT(error("<!DOCTYPE s [<!ENTITY"), HasSubstr("DOCTYPE"));
}

TEST_F(NoriXml, RefusesDeepNestingWithoutOverflow) {
  std::string text = "<scene>";
  for (int i = 0; i < 200000; ++i) text += "<a type='b'>";
  EXPECT_THAT(error(text + "<"), HasSubstr("s.xml:1:"));
  for (int i = 0; i < 200000; ++i) text += "</a>";
  EXPECT_THAT(error(text + "</scene>"), HasSubstr("nested more than 64 deep"));
}

TEST_F(NoriXml, ReadsManyPropertiesInReasonableTime) {
  std::string text = "<scene>";
  for (int i = 0; i < 100000; ++i) text += "<float name='a" + std::to_string(i) + "' value='1'/>";
  EXPECT_EQ(read(text + "</scene>").root.properties.size(), 100000u);
}

TEST_F(NoriXml, RefusesFilesThatAreNone) {
  EXPECT_THROW(
      {
        try {
          read_nori_xml(directory_);
        } catch (const InputError& e) {
          EXPECT_EQ(std::string(e.what()), directory_.string() + ": this is a folder, not a file");
          throw;
        }
      },
      InputError);
  EXPECT_THROW(read_nori_xml(directory_ / "none.xml"), InputError);
  EXPECT_THROW(read_text_file(write("<scene/>"), 7), InputError);
  EXPECT_NO_THROW(read_text_file(write("<scene/>"), 8));
}

/// `ascii` with each character in `bytes` bytes, behind `mark`.
std::string widen(const std::string& ascii, std::size_t bytes, bool is_big_endian, const std::string& mark) {
  std::string wide = mark;
  for (const char c : ascii) {
    const std::string zeros(bytes - 1, '\0');
    wide += is_big_endian ? zeros + c : c + zeros;
  }
  return wide;
}

TEST_F(NoriXml, ReadsEveryUnicodeEncodingWithTheSamePlaces) {
  const std::string text = "<scene>\n <float name='a' value='2x'/></scene>";
  const std::string expected = error(text);
  ASSERT_THAT(expected, StartsWith("s.xml:2:25: '2x' is not a number"));
  EXPECT_EQ(error("\xEF\xBB\xBF" + text), expected);
  for (const std::string& mark : {std::string(), std::string("\xFF\xFE")})
    EXPECT_EQ(error(widen(text, 2, false, mark)), expected);
  for (const std::string& mark : {std::string(), std::string("\xFE\xFF")})
    EXPECT_EQ(error(widen(text, 2, true, mark)), expected);
  for (const std::string& mark : {std::string(), std::string("\xFF\xFE\0\0", 4)})
    EXPECT_EQ(error(widen(text, 4, false, mark)), expected);
  for (const std::string& mark : {std::string(), std::string("\0\0\xFE\xFF", 4)})
    EXPECT_EQ(error(widen(text, 4, true, mark)), expected);
}

TEST_F(NoriXml, ReadsLatin1OnlyWhereDeclared) {
  const std::string scene = "<scene><string name='a' value='\xE9'/></scene>";
  EXPECT_THAT(error(scene), StartsWith("s.xml:1:32: not valid UTF-8"));
  const SceneDesc read_scene = read("<?xml version='1.0' encoding='ISO-8859-1'?>" + scene);
  EXPECT_EQ(std::get<std::string>(read_scene.root.properties.at(0).value), "\xC3\xA9");
}

TEST_F(NoriXml, RefusesBrokenEncodings) {
  EXPECT_THAT(error(std::string("<scene/>\0", 9)), HasSubstr("NUL"));
  EXPECT_THAT(error(std::string("\xFF\xFE<\0s", 5)), HasSubstr("ends inside a character"));
  EXPECT_THAT(error(std::string("\xFF\xFE<\0\0\xD8<\0", 8)), HasSubstr("byte 2 is not valid UTF-16"));
  EXPECT_THAT(error(std::string("\xFF\xFE\0\0\0\0\x11\0", 8)), HasSubstr("byte 0 is not valid UTF-32"));
  EXPECT_EQ(error("\xEF\xBB\xBF"), "s.xml: the file is empty");
}

TEST_F(NoriXml, TellsTheDialectAndWhy) {
  const std::string light =
      "<mesh type='obj'><luminaire type='area'/><bsdf type='diffuse'/></mesh><camera type='a'/>";
  EXPECT_EQ(read("<scene>" + light + "</scene>").dialect, Dialect::nori_2012);
  EXPECT_THAT(read("<scene>" + light + "</scene>").dialect_reason, HasSubstr("<luminaire>"));
  EXPECT_EQ(read("<scene><emitter type='point'/></scene>").dialect, Dialect::nori);
  EXPECT_EQ(read("<scene/>").dialect, Dialect::nori);
  EXPECT_EQ(read("<scene dialect='nori-eth'>" + light + "</scene>").dialect, Dialect::nori_eth);
  EXPECT_THAT(read("<scene dialect='nori-eth'/>").dialect_reason, HasSubstr("line 1"));
  EXPECT_EQ(read_nori_xml(write("<scene dialect='nori-eth'/>"), Dialect::nori_2012).dialect,
            Dialect::nori_2012);
  EXPECT_THAT(error("<scene dialect='nori-2021'/>"), StartsWith("s.xml:1:17: unknown dialect 'nori-2021'"));
  EXPECT_THAT(error("<scene><mesh type='obj' dialect='nori'/></scene>"),
              HasSubstr("unknown attribute 'dialect'"));
  for (const char* name : {"nori", "nori-eth", "nori-2012"})
    EXPECT_EQ(dialect_name(dialect_from_name(name)), name);
  EXPECT_THROW(dialect_from_name("mitsuba"), InputError);
}

TEST_F(NoriXml, TellsTheDialectByNamesThatOneGenerationHas) {
  const auto guess = [&](const std::string& inside) {
    const SceneDesc scene = read("<scene>\n" + inside + "</scene>");
    EXPECT_THAT(scene.dialect_reason,
                scene.dialect == Dialect::nori ? HasSubstr("nothing in the file") : HasSubstr("in line 2"));
    EXPECT_EQ(scene.is_dialect_told, scene.dialect != Dialect::nori);
    return scene.dialect;
  };
  for (const char* inside :
       {"<mesh type='sphere'/>", "<emitter type='distantdisk'/>", "<integrator type='av'/>",
        "<integrator type='material'/>", "<emitter type='point'><color name='power' value='1'/></emitter>",
        "<mesh type='obj'><bsdf type='diffuse'><texture type='uvtexture' name='albedo'/></bsdf></mesh>",
        "<mesh type='obj'><bsdf type='diffuse'><texture type='checkerboard_color' name='a'/></bsdf></mesh>"})
    EXPECT_EQ(guess(inside), Dialect::nori_eth) << inside;
  for (const char* inside :
       {"<integrator type='mipath'/>", "<mesh type='obj'><luminaire type='area'/></mesh>",
        "<mesh type='sphere'><luminaire type='area'/></mesh>"})
    EXPECT_EQ(guess(inside), Dialect::nori_2012) << inside;
  for (const char* inside :
       {"", "<shape type='sphere'/>", "<emitter type='point'><color name='intensity' value='1'/></emitter>",
        "<emitter type='area'/>", "<integrator type='direct_ems'/>", "<medium type='homogeneous'/>",
        "<bsdf type='av'/>", "<integrator type='path'/>",
        "<camera type='perspective'><float name='apertureRadius' value='1'/></camera>"})
    EXPECT_EQ(guess(inside), Dialect::nori) << inside;
  EXPECT_EQ(guess("<shape type='sphere'/>\n<!-- <luminaire> -->"), Dialect::nori);
}

TEST_F(NoriXml, AFolderTellsTheDialectOfAllItsScenes) {
  const auto settings = [&](const std::string& text) {
    std::ofstream(directory_ / "etendue.json", std::ios::binary | std::ios::trunc) << text;
  };
  settings("{\"dialect\": \"nori-eth\"}");
  const SceneDesc scene = read("<scene/>");
  EXPECT_EQ(scene.dialect, Dialect::nori_eth);
  EXPECT_THAT(scene.dialect_reason, HasSubstr("etendue.json"));
  EXPECT_TRUE(scene.is_dialect_told);
  EXPECT_EQ(scene.settings_file.filename(), "etendue.json");
  // It beats what names tell; the file's own statement and the command line beat it.
  EXPECT_EQ(read("<scene><integrator type='mipath'/></scene>").dialect, Dialect::nori_eth);
  EXPECT_EQ(read("<scene dialect='nori-2012'/>").dialect, Dialect::nori_2012);
  EXPECT_EQ(read_nori_xml(write("<scene/>"), Dialect::nori).dialect, Dialect::nori);
  fs::create_directories(directory_ / "below" / "deep");
  std::ofstream(directory_ / "below" / "deep" / "s.xml") << "<scene/>";
  EXPECT_EQ(read_nori_xml(directory_ / "below" / "deep" / "s.xml").dialect, Dialect::nori_eth);
  settings("{\"dialect\": \"nori-etH\"}");
  EXPECT_THAT(error("<scene/>"), HasSubstr("did you mean 'nori-eth'?"));
  settings("{\"dialects\": \"nori\"}");
  EXPECT_THAT(error("<scene/>"), HasSubstr("unknown key 'dialects'"));
  settings("{\"dialect\": 1}");
  EXPECT_THAT(error("<scene/>"), HasSubstr("'dialect' must be text"));
  settings("dialect = nori");
  EXPECT_THAT(error("<scene/>"), HasSubstr("not well-formed JSON"));
  settings("{");
  EXPECT_THAT(error("<scene/>"), HasSubstr("not well-formed JSON"));
  settings("[]");
  EXPECT_THAT(error("<scene/>"), HasSubstr("not a JSON object"));
}

TEST_F(NoriXml, NamesTheFormatOfWhatIsNoXml) {
  for (const auto& [text, name] : std::vector<std::pair<std::string, std::string>>{
           {"# made by hand\nLookAt 0 0 5  0 0 0  0 1 0\n", "a pbrt scene"},
           {"Film \"rgb\"\n", "a pbrt scene"},
           {"{\"asset\": {\"version\": \"2.0\"}}", "a glTF scene"},
           {std::string("glTF\x02\0\0\0", 8), "a glTF scene"},
           {"#usda 1.0\n", "a USD scene"},
           {std::string("BLENDER-v300\0", 13), "a Blender file"},
           {"scene.camera.type = \"perspective\"\n", "a LuxCore scene"},
           {"#version 3.7;\nglobal_settings {}\n", "a POV-Ray scene"},
           {"// a comment\ncamera { location 0 }\n", "a POV-Ray scene"},
           {"v 0 0 0\n", "an OBJ mesh"},
           {"ply\nformat ascii 1.0\n", "a PLY mesh"}})
    EXPECT_THAT(error(text), HasSubstr("this is " + name)) << text;
}

TEST_F(NoriXml, ACameraMayLookAlongItsUp) {
  const std::string lookat =
      "<transform name='toWorld'><lookat origin='0,0,5' target='0,0,1' up='0,0,1'/></transform>";
  const SceneDesc scene = read("<scene><camera type='perspective'>" + lookat + "</camera></scene>");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("up is parallel"));
  const auto& t = std::get<Transform>(scene.root.children[0].properties[0].value);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(t.m[row][0], 0);
    EXPECT_EQ(t.m[row][1], 0);
  }
  EXPECT_EQ(t.m[2][2], -1);
  EXPECT_THAT(error("<scene><shape type='sphere'>" + lookat + "</shape></scene>"), HasSubstr("up is 0 or"));
}

TEST_F(NoriXml, AFileOfTestsHasOneDialect) {
  const SceneDesc test = read(
      "<test type='ttest'><scene><integrator type='path'/></scene>\n"
      "<scene><integrator type='mipath'/></scene></test>");
  EXPECT_EQ(test.dialect, Dialect::nori_2012);
  EXPECT_EQ(test.dialect_reason,
            "<integrator type=\"mipath\"> in line 2: only the first generation has that");
  EXPECT_EQ(read("<test type='ttest'><string name='distances' value='1'/></test>").dialect,
            Dialect::nori_eth);
  EXPECT_EQ(read("<test type='ttest'><string name='angles' value='1'/></test>").dialect, Dialect::nori);
}

TEST_F(NoriXml, LeavesOutWhatHasNoPartInTheImage) {
  const SceneDesc scene = read(
      "<scene>\n <evaluator type='variance'><string name='reference' value='a.exr'/></evaluator>"
      "<camera type='a'/><previewer type='x'/></scene>");
  ASSERT_EQ(scene.root.children.size(), 1u);
  EXPECT_EQ(scene.root.children[0].family, "camera");
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("s.xml:2:3: <evaluator> is ignored: it has no part in the image"));
  // A slip stays in, for the loader to refuse with the name that was meant; so does anything it might need.
  EXPECT_EQ(read("<scene><emiter type='area'/></scene>").root.children.size(), 1u);
  EXPECT_TRUE(read("<scene><emiter type='area'/></scene>").warnings.empty());
  EXPECT_EQ(
      read("<scene><mesh type='a'><evaluator type='b'/></mesh></scene>").root.children[0].children.size(),
      1u);
}

TEST_F(NoriXml, ReadsTheLooseWaysOfCourses) {
  for (const char* before : {"\n", " \t\r\n", "<!-- Cornell box -->\n", "\n\n<!-- a --><!-- b -->\n\n"})
    EXPECT_EQ(error(std::string(before) + "<?xml version='1.0' encoding='utf-8'?>\n<scene/>"), "") << before;
  for (const char* numbers : {"1,2,3", "1 2 3", "1, 2, 3", " 1 ,2\n\t3 ", "1,2 3"})
    EXPECT_EQ(std::get<Colorf>(value("<color name='a' value='" + std::string(numbers) + "'/>")),
              (Colorf{1, 2, 3}))
        << numbers;
  const auto expected = std::get<Transform>(
      value("<transform name='a'><matrix value='1 2 3 4  5 6 7 9  9 8 1 2  0 0 0 1'/></transform>"));
  for (const char* numbers :
       {"1 2 3 4; 5 6 7 9; 9 8 1 2; 0 0 0 1", "1, 2, 3, 4; 5, 6, 7, 9; 9, 8, 1, 2; 0, 0, 0, 1",
        "1 2 3 4;5 6 7 9;9 8 1 2;0 0 0 1;", "1,2,3,4,5,6,7,9,9,8,1,2,0,0,0,1"})
    EXPECT_EQ(std::get<Transform>(value("<transform name='a' value='" + std::string(numbers) + "'/>")),
              expected)
        << numbers;
}

TEST_F(NoriXml, ReadsTexturesAndPhaseFunctionsAsChildrenWithNames) {
  const SceneDesc scene = read(
      "<scene><mesh type='obj'><bsdf type='diffuse'><texture type='checkerboard_color' name='albedo'>"
      "<point name='delta' value='0.3,0.3'/></texture></bsdf></mesh>"
      "<medium type='homogeneous'><phase type='isotropic'/></medium></scene>");
  const Object& texture = scene.root.children[0].children[0].children[0];
  EXPECT_EQ(texture.family, "texture");
  EXPECT_EQ(texture.type, "checkerboard_color");
  EXPECT_EQ(texture.name, "albedo");
  EXPECT_EQ(std::get<Vec2<double>>(texture.properties[0].value), (Vec2<double>{0.3, 0.3}));
  EXPECT_EQ(scene.root.children[1].children[0].family, "phase");
}

std::vector<fs::path> xml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".xml") files.push_back(entry.path());
  return files;
}

TEST(NoriXmlData, ReadsTheScenesAndTestsOfRealCourses) {
  if (!fs::is_directory(test::data_folder())) GTEST_SKIP() << "no test data";
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::data_folder())) {
    if (!entry.path().filename().string().starts_with("nori-")) continue;
    for (const fs::path& file : xml_files(entry.path())) {
      ++count;
      EXPECT_NO_THROW({
        try {
          const SceneDesc scene = read_nori_xml(file);
          EXPECT_FALSE(scene.root.children.empty()) << file;
        } catch (const InputError& e) {
          ADD_FAILURE() << e.what();
        }
      });
    }
  }
  EXPECT_GT(count, 0);
}

TEST(NoriXmlData, NoFileIsTakenForAnotherGeneration) {
  if (!fs::is_directory(test::data_folder())) GTEST_SKIP() << "no test data";
  int told = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::data_folder())) {
    const std::string folder = entry.path().filename().string();
    if (!folder.starts_with("nori-")) continue;
    const bool is_first =
        folder.find("2012") != std::string::npos || folder.find("acg13") != std::string::npos;
    const bool is_eth =
        folder.find("eth") != std::string::npos || folder.find("tuebingen") != std::string::npos;
    const Dialect expected = is_first ? Dialect::nori_2012 : is_eth ? Dialect::nori_eth : Dialect::nori;
    for (const fs::path& file : xml_files(entry.path())) {
      const SceneDesc scene = read_nori_xml(file);
      if (scene.dialect == Dialect::nori) continue;  // Nothing in it tells.
      ++told;
      EXPECT_EQ(scene.dialect, expected) << file << ": " << scene.dialect_reason;
    }
  }
  EXPECT_GT(told, 10);
}

TEST(NoriXmlData, RefusesBadFilesByName) {
  if (!fs::is_directory(test::data_folder())) GTEST_SKIP() << "no test data";
  for (const fs::path& file : xml_files(test::data_folder() / "badinput" / "xml")) {
    try {
      read_nori_xml(file);
    } catch (const InputError& e) {
      EXPECT_THAT(std::string(e.what()), StartsWith(file.string() + ":"));
    }
  }
}

TEST_F(NoriXml, AnyTruncationOrByteGivesASceneOrAnInputError) {
  const std::string text =
      "<?xml version=\"1.0\"?>\n<test type=\"ttest\"><!-- c --><scene>\n<transform name='t'><scale "
      "value=\"1,2 3\"/>"
      "<lookat origin='0 0 0' target='0 0 1' up='0 1 0'/></transform><string name=\"s\" value=\"&lt;&#65;\"/>"
      "<bsdf type=\"x\"><color name='c' value=\".5\"/></bsdf></scene></test>";
  ASSERT_EQ(error(text), "");
  const auto attempt = [&](const std::string& damaged) {
    try {
      read(damaged);
    } catch (const InputError&) {
    }
  };
  for (std::size_t length = 0; length < text.size(); ++length) attempt(text.substr(0, length));
  const std::string bytes("<>\"'=/&! \0\xFF[x", 13);
  for (std::size_t at = 0; at < text.size(); ++at)
    for (const char byte : bytes) {
      std::string damaged = text;
      damaged[at] = byte;
      attempt(damaged);
    }
}

}  // namespace
}  // namespace etendue

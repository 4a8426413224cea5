// Lights as files state them: what is refused, with which message, and what follows from the words.
#include "scene/load_light.h"

#include "geometry/bounds.h"
#include "image/image_file.h"
#include "support/data_folder.h"
#include "support/error_of.h"
#include "test_scene.h"

#include <ImfEnvmap.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace etendue {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string camera = camera_xml({0, 0, 4}, {0, 0, 0}, 30, 4, "independent");
const std::string unlit_rectangle = rectangle_xml({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "");

/// The message of the error that these lights are.
std::string error_of_lights(const std::string& lights) {
  return test::error_of([&] { load_scene_text(camera + unlit_rectangle + lights); });
}

class EnvmapFile : public testing::Test {
 protected:
  /// Loads a scene whose environment map `write` makes.
  template <class Write>
  LoadedScene load_file(const Write& write) const {
    write(folder_.path() / "map.exr");
    std::ofstream(folder_.path() / "scene.xml")
        << "<scene>" << camera << unlit_rectangle
        << R"(<emitter type="envmap"><string name="filename" value="map.exr"/></emitter></scene>)";
    return load_scene(read_nori_xml(folder_.path() / "scene.xml", Dialect::nori));
  }
  LoadedScene load(const Image& image) const {
    return load_file([&](const std::filesystem::path& file) { write_exr(file, image); });
  }
  std::string error_of_lights(const Image& image) const {
    return test::error_of([&] { load(image); });
  }
  template <class Write>
  std::string error_of_file(const Write& write) const {
    return test::error_of([&] { load_file(write); });
  }
  static Image grey(float value, float odd) {
    Image image{4, 2, {{"B", {}}, {"G", {}}, {"R", {}}}, {}};
    for (Channel& channel : image.channels) channel.values.assign(8, value);
    image.channels[1].values[6] = odd;
    return image;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(EnvmapFile, IsNamedWithTheTexelThatCannotBeUsed) {
  EXPECT_EQ(error_of_lights(grey(1, 0)), "");
  EXPECT_THAT(error_of_lights(grey(1, NAN)),
              AllOf(HasSubstr("scene.xml:"), HasSubstr("map.exr: texel (2, 1) is 1 nan 1")));
  EXPECT_THAT(error_of_lights(grey(1, -0.5f)), HasSubstr("map.exr: texel (2, 1) is 1 -0.5 1"));
  EXPECT_THAT(error_of_lights(grey(1, std::numeric_limits<float>::infinity())),
              HasSubstr("texel (2, 1) is 1 inf 1"));
  EXPECT_THAT(error_of_lights(grey(1, 2e30f)), HasSubstr("number from 0 to 1e+30"));
  EXPECT_THAT(error_of_lights(grey(0, 0)), HasSubstr("map.exr: all texels are 0"));
}

TEST_F(EnvmapFile, MayBeGreyButNotWithoutColour) {
  EXPECT_EQ(load({2, 1, {{"Y", {1, 2}}}, {}}).scene.lights.infinite_count(), 1);
  EXPECT_THAT(error_of_lights({2, 1, {{"G", {1, 2}}, {"Z", {1, 2}}}, {}}),
              AllOf(HasSubstr("'map.exr' has no colours: these are the channels R, G and B, or Y"),
                    HasSubstr("it has: G, Z")));
}

TEST_F(EnvmapFile, IsNoCubeMap) {
  EXPECT_THAT(error_of_file([](const std::filesystem::path& file) {
                Imf::Header header(1, 6);
                Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
                Imf::RgbaOutputFile output(file.c_str(), header);
                const std::array<Imf::Rgba, 6> pixels{};
                output.setFrameBuffer(pixels.data(), 1, 1);
                output.writePixels(6);
              }),
              AllOf(HasSubstr("map.exr: this image says that it is a cube map"), HasSubstr("exrenvmap -l")));
}

/// The largest and the smallest of what can be told apart; nothing overflows on the way.
TEST_F(EnvmapFile, MayHaveAnyContrast) {
  Image image = grey(1e-30f, 1e-30f);
  for (Channel& channel : image.channels) channel.values[5] = 1e30f;
  const LoadedScene loaded = load(image);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const LightSample<float> sample =
        loaded.scene.lights.sample<float>(0, 1, Receiver<float>{}, {i << 22, i * 2654435761u}, true);
    ASSERT_TRUE(sample.is_there);
    ASSERT_TRUE(std::isfinite(sample.radiance_over_pdf.g) && std::isfinite(sample.pdf_solid_angle));
  }
}

/// What OpenEXR's own tests call valid: read and used, or refused for what is in it.
TEST(EnvmapFiles, OfOthersAreReadOrRefusedWithAReason) {
  const std::filesystem::path folder = test::data_folder() / "badinput" / "exr-valid";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
  int used = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string message =
        error_of_lights("<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
                        std::filesystem::absolute(entry.path()).string() + "\"/></emitter>");
    if (message.empty())
      ++used;
    else
      EXPECT_THAT(message, HasSubstr(entry.path().filename().string()));
    if (entry.path().filename() == "BrightRingsNanInf.exr") {
      EXPECT_THAT(message, HasSubstr("texel ("));
    }
  }
  EXPECT_GT(used, 10);
}

TEST(LoadLight, RefusesWhatMakesNoSense) {
  const auto light = [](const std::string& type, const std::string& inside) {
    return error_of_lights("<emitter type=\"" + type + "\">" + inside + "</emitter>");
  };
  EXPECT_THAT(light("area", ""), HasSubstr("has no place inside <scene>"));
  EXPECT_THAT(light("sky", ""), AllOf(HasSubstr("unknown emitter 'sky'"), HasSubstr("envmap")));
  EXPECT_THAT(light("point", R"(<color name="power" value="1"/><color name="intensity" value="1"/>)"),
              HasSubstr("both 'intensity' and 'power' are stated"));
  EXPECT_THAT(light("point", R"(<color name="power" value="-1"/>)"), HasSubstr("not negative"));
  EXPECT_THAT(light("point", R"(<point name="position" value="1e39,0,0"/>)"),
              HasSubstr("beyond what can be rendered"));
  EXPECT_THAT(light("directional", R"(<vector name="direction" value="0,0,0"/>)"),
              HasSubstr("has no direction"));
  EXPECT_THAT(light("spot", R"(<float name="cutoffAngle" value="0"/>)"), HasSubstr("'cutoffAngle' is 0"));
  EXPECT_THAT(light("spot", R"(<float name="beamWidth" value="21"/>)"), HasSubstr("'beamWidth' is 21"));
  EXPECT_THAT(light("distantdisk", ""), HasSubstr("lacks 'thetaA'"));
  EXPECT_THAT(light("distantdisk", R"(<float name="thetaA" value="181"/>)"), HasSubstr("'thetaA' is 181"));
  EXPECT_THAT(light("distantdisk", R"(<float name="thetaA" value="90"/>
    <transform name="toWorld"><scale value="1,2,1"/></transform>)"),
              HasSubstr("is no rotation"));
  EXPECT_THAT(light("envmap", ""), HasSubstr("lacks 'filename'"));
  EXPECT_THAT(light("envmap", R"(<string name="filename" value="none.exr"/>)"),
              HasSubstr("'none.exr' is not there"));
  EXPECT_THAT(light("envmap", R"(<string name="filename" value="scene.xml"/>)"),
              HasSubstr("neither an EXR nor a PNG"));
  EXPECT_THAT(
      light("envmap", R"(<string name="filename" value="scene.xml"/><float name="scale" value="-1"/>)"),
      HasSubstr("'scale' is -1"));
}

TEST(LoadLight, TakesLightsInTheSceneAndInsideShapes) {
  const LoadedScene loaded = load_scene_text(
      camera + R"(<emitter type="point" name="lamp"/><luminaire type="constant"/>)" +
      sphere_xml({0, 0, 0}, 1, R"(<emitter type="spot"/>)") + sphere_xml({3, 0, 0}, 1, light_xml(2)));
  const Lights& lights = loaded.scene.lights;
  ASSERT_EQ(lights.count(), 4);
  EXPECT_EQ(lights.name(0), "lamp");
  EXPECT_EQ(lights.name(1), "constant 2");
  EXPECT_EQ(lights.infinite_count(), 1);
  EXPECT_EQ(lights.infinite_light(0), 1);
  // A sphere about a spot light does not shine.
  EXPECT_EQ(loaded.scene.geometry.light, (std::vector<std::int32_t>{-1, 3}));
}

TEST(LoadLight, AsksForALightOnlyWhereOneIsNeeded) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "scene.xml") << "<scene>" << camera << unlit_rectangle << "</scene>";
  const SceneDesc description = read_nori_xml(folder.path() / "scene.xml", Dialect::nori);
  const LoadedScene loaded = load_scene(description);
  EXPECT_THROW(check_has_light(description, loaded.scene), InputError);
}

TEST(BoundingSphere, HoldsAllShapesAndNothingElse) {
  const LoadedScene loaded = load_scene_text(camera + rectangle_xml({5, 5, 5}, {1, 0, 0}, {0, 2, 0}, "") +
                                             sphere_xml({9, 5, 5}, 2, ""));
  const Sphere bounds = bounding_sphere(loaded.scene.geometry);
  EXPECT_NEAR(bounds.center.x, 7.5, 1e-6);
  EXPECT_NEAR(bounds.center.y, 5, 1e-6);
  EXPECT_NEAR(bounds.radius, std::sqrt(3.5 * 3.5 + 2 * 2 + 2 * 2), 1e-5);
  EXPECT_EQ(bounding_sphere(Geometry{}).radius, 0);
}

}  // namespace
}  // namespace etendue

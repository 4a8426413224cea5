// Textures: what they give where, and the images they come from.
//
// Seen to fail when: delta is added, or divided by scale; value1 and value2 are swapped; rows stand from the
// top; pixels have their colour at their corners; a mirrored coordinate is one pixel off.
#include "texture/texture.h"

#include "bsdf/bsdf.h"
#include "image/image_file.h"
#include "support/error_of.h"
#include "test_scene.h"

#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Colorf at(const ColorTexture& texture, float u, float v) { return color_at(texture, Vec2f{u, v}, true); }

TEST(Texture, CheckerboardSquaresHaveTheirSizeAndAreShiftedByWholeOnes) {
  const Colorf even{0.8f, 0.2f, 0.4f}, odd{0.2f, 0.55f, 0.1f};
  const Checkerboard plain{even, odd, {0, 0}, {0.5f, 0.25f}};
  EXPECT_EQ(at(plain, 0.1f, 0.1f), even);
  EXPECT_EQ(at(plain, 0.6f, 0.1f), odd);
  EXPECT_EQ(at(plain, 0.1f, 0.3f), odd);
  EXPECT_EQ(at(plain, 0.6f, 0.3f), even);
  EXPECT_EQ(at(plain, -0.1f, 0.1f), odd);
  EXPECT_EQ(at(plain, -0.1f, -0.1f), even);
  // 0.2 / 0.5 - 0.3 = 0.1 is in square 0; (0.2 - 0.3) / 0.5 would be in square -1.
  const Checkerboard shifted{even, odd, {0.3f, 0}, {0.5f, 0.25f}};
  EXPECT_EQ(at(shifted, 0.2f, 0.1f), even);
  EXPECT_EQ(at(shifted, 0.6f, 0.1f), even);
  EXPECT_EQ(at(shifted, 0.1f, 0.1f), odd);
}

TEST(Texture, CoordinatesAreModuloOneWithARipple) {
  const Colorf flat = at(UvTexture{}, 3.25f, -0.5f);  // The ripple's sines are 0 here.
  EXPECT_NEAR(flat.r, 0.25, 1e-6);
  EXPECT_NEAR(flat.g, 0.5, 1e-6);
  EXPECT_EQ(flat.b, 0.5f);
  const double u = 0.27, v = 0.61, c = 16 * std::numbers::pi;
  const Colorf there = at(UvTexture{}, float(u), float(v));
  EXPECT_NEAR(there.r, u * (1 - 0.2 * std::sin(c * u) * std::sin(c * v)), 1e-5);
  EXPECT_NEAR(there.g, v * (1 - 0.2 * std::cos(c * u) * std::sin(c * v)), 1e-5);
}

/// Two columns, three rows from the top; red tells the pixel: 0 1 / 2 3 / 4 5.
void write_six_pixels(const std::filesystem::path& file) {
  write_exr(file,
            {2, 3, {{"R", {0, 1, 2, 3, 4, 5}}, {"G", {1, 1, 1, 1, 1, 1}}, {"B", {0, 0, 0, 0, 0, 0}}}, {}});
}

ColorTexture load(const std::string& inside, const std::function<void(const std::filesystem::path&)>& prepare,
                  const std::string& type = "imagetexture") {
  const test::TemporaryFolder folder;
  prepare(folder.path());
  std::ofstream(folder.path() / "scene.xml")
      << "<scene><bsdf type=\"diffuse\"><texture type=\"" << type << "\" name=\"albedo\">" << inside
      << "</texture></bsdf></scene>";
  const SceneDesc scene = read_nori_xml(folder.path() / "scene.xml", Dialect::nori);
  std::vector<UnreadKey> unread;
  TextureFiles files{scene.directory};
  return std::get<Diffuse>(make_material(scene.root.children.front(), files, unread)).albedo;
}
std::string file_xml(const std::string& name) {
  return fmt::format("<string name=\"filename\" value=\"{}\"/>", name);
}
ColorTexture six_pixels(const std::string& more) {
  return load(file_xml("a.exr") + more, [](const auto& folder) { write_six_pixels(folder / "a.exr"); });
}

TEST(Texture, ImagesStandUprightAndAreBilinearBetweenCentres) {
  const ColorTexture image = six_pixels("");
  EXPECT_FLOAT_EQ(at(image, 0.25f, 1 / 6.0f).r, 4);  // Lower left.
  EXPECT_FLOAT_EQ(at(image, 0.75f, 1 / 6.0f).r, 5);
  EXPECT_FLOAT_EQ(at(image, 0.25f, 5 / 6.0f).r, 0);  // Upper left.
  EXPECT_FLOAT_EQ(at(image, 0.5f, 0.5f).r, 2.5f);
  EXPECT_NEAR(at(image, 0.35f, 1 / 3.0f).r, 0.8 * 3 + 0.2 * 4, 1e-5);
  EXPECT_FLOAT_EQ(at(image, 0.5f, 0.5f).g, 1);
}

TEST(Texture, AnImageFileIsReadAndKeptOnce) {
  const test::TemporaryFolder folder;
  write_six_pixels(folder.path() / "a.exr");
  std::ofstream(folder.path() / "scene.xml") << [] {
    std::string text = "<scene>";
    for (const std::string more :
         {"", "<string name=\"wrap\" value=\"clamp\"/>", "<boolean name=\"raw\" value=\"true\"/>"})
      text += "<bsdf type=\"diffuse\"><texture type=\"imagetexture\" name=\"albedo\">" + file_xml("a.exr") +
              more + "</texture></bsdf>";
    return text + "</scene>";
  }();
  const SceneDesc scene = read_nori_xml(folder.path() / "scene.xml", Dialect::nori);
  std::vector<UnreadKey> unread;
  TextureFiles files{scene.directory};
  std::vector<ImageTexture> images;
  for (const Object& bsdf : scene.root.children)
    images.push_back(std::get<ImageTexture>(std::get<Diffuse>(make_material(bsdf, files, unread)).albedo));
  EXPECT_EQ(images[0].pixels, images[1].pixels);
  EXPECT_NE(images[0].pixels, images[2].pixels);
  EXPECT_EQ(images[0].wrap, ImageTexture::Wrap::repeat);
  EXPECT_EQ(images[1].wrap, ImageTexture::Wrap::clamp);
  EXPECT_EQ(images[2].width, 2);
}

TEST(Texture, ImagesWrapAsAsked) {
  const std::string nearest = "<string name=\"interpolation\" value=\"nearest\"/>";
  const auto wrap = [](const std::string& how) {
    return fmt::format("<string name=\"wrap\" value=\"{}\"/>", how);
  };
  const ColorTexture repeat = six_pixels(nearest), mirror = six_pixels(nearest + wrap("mirror")),
                     clamp = six_pixels(nearest + wrap("clamp"));
  for (const auto& [u, v, repeated, mirrored, clamped] : {std::tuple{0.3f, 0.1f, 4, 4, 4},
                                                          {1.3f, 0.1f, 4, 5, 5},
                                                          {-0.3f, 0.1f, 5, 4, 4},
                                                          {0.3f, 1.1f, 4, 0, 0},
                                                          {0.3f, -0.1f, 0, 4, 4},
                                                          {-1.3f, -2.1f, 1, 5, 4},
                                                          {1e6f, 0.1f, 4, 4, 5}}) {
    EXPECT_EQ(at(repeat, u, v).r, float(repeated)) << u << " " << v;
    EXPECT_EQ(at(mirror, u, v).r, float(mirrored)) << u << " " << v;
    EXPECT_EQ(at(clamp, u, v).r, float(clamped)) << u << " " << v;
  }
  // At the very seam, between the last and the first pixel.
  EXPECT_FLOAT_EQ(at(six_pixels(""), 1, 1 / 6.0f).r, 4.5f);
  EXPECT_FLOAT_EQ(at(six_pixels(wrap("clamp")), 1, 1 / 6.0f).r, 5);
}

TEST(Texture, OtherNamesOfTheForks) {
  const auto six = [](const auto& folder) { write_six_pixels(folder / "a.exr"); };
  EXPECT_EQ(at(load(file_xml("a.exr"), six, "image_texture"), 0.3f, 0.6f), at(six_pixels(""), 0.3f, 0.6f));
  const ColorTexture constant = load(
      "<color name=\"value\" value=\"0.1 0.2 0.3\"/>", [](const auto&) {}, "constant_color");
  EXPECT_TRUE(is_uniform(constant));
  EXPECT_EQ(at(constant, 0.3f, 0.6f), (Colorf{0.1f, 0.2f, 0.3f}));
}

TEST(Texture, ImagesMayHaveLayers) {
  const auto two_layers = [](const std::filesystem::path& folder) {
    write_exr(
        folder / "a.exr",
        {1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}, {"rust.R", {3}}, {"rust.G", {2}}, {"rust.B", {1}}}, {}});
  };
  const auto layer = [](const std::string& name) {
    return fmt::format("<string name=\"layer\" value=\"{}\"/>", name);
  };
  EXPECT_EQ(at(load(file_xml("a.exr"), two_layers), 0.5f, 0.5f), (Colorf{1, 1, 1}));
  EXPECT_EQ(at(load(file_xml("a.exr") + layer("rust"), two_layers), 0.5f, 0.5f), (Colorf{3, 2, 1}));
  EXPECT_THAT(test::error_of([&] { load(file_xml("a.exr") + layer("rest"), two_layers); }),
              AllOf(HasSubstr("scene.xml:1:"), HasSubstr("'a.exr' has no layer 'rest'"),
                    HasSubstr("^~~~\ndid you mean 'rust'?")));
}

TEST(Texture, BadOnesAreErrorsThatNameThem) {
  const auto nothing = [](const std::filesystem::path&) {};
  EXPECT_THAT(test::error_of([&] { load(file_xml("b.png"), nothing); }), HasSubstr("'b.png' is not there"));
  EXPECT_THAT(test::error_of([&] { load("", nothing); }), HasSubstr("lacks 'filename'"));
  EXPECT_THAT(test::error_of([&] { load(file_xml("scene.xml"), nothing); }),
              HasSubstr("'scene.xml' is neither an EXR nor a PNG, JPEG or Radiance HDR image"));
  EXPECT_THAT(test::error_of([&] { six_pixels("<string name=\"wrap\" value=\"repeated\"/>"); }),
              HasSubstr("did you mean 'repeat'?"));
  EXPECT_THAT(test::error_of([&] {
                load(file_xml("a.exr"), [](const std::filesystem::path& folder) {
                  write_exr(folder / "a.exr", {1, 1, {{"Y", {-1}}}, {}});
                });
              }),
              HasSubstr("has -1 in pixel 0, 0"));
}

}  // namespace
}  // namespace etendue

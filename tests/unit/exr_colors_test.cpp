// EXR files as colours: layers, parts, primaries, luminance and chroma.
//
// Seen to fail when: chromaticities are passed over, or heeded for raw values; the first of several layers is
// taken in silence; Y beside X and Z is taken for luminance; colours are cut to the data window.
#include "image/image_file.h"
#include "support/temporary_image.h"

#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfEnvmap.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <gmock/gmock.h>

namespace etendue {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class ExrColors : public test::ImageFileTest {
 protected:
  /// One pixel; channel k of the list has the value k + 1.
  void write(const std::vector<std::string>& channels, Imf::Header header = Imf::Header(1, 1)) const {
    std::vector<float> values;
    for (std::size_t k = 0; k < channels.size(); ++k) values.push_back(float(k + 1));
    Imf::FrameBuffer pixels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      header.channels().insert(channels[k], Imf::Channel(Imf::FLOAT));
      pixels.insert(channels[k], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&values[k]), sizeof(float),
                                            sizeof(float)));
    }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(pixels);
    output.writePixels(1);
  }
  /// A part for each list of channels, named by the first of it; values count through all.
  void write_parts(const std::vector<std::vector<std::string>>& parts) const {
    std::vector<Imf::Header> headers;
    for (const auto& part : parts) {
      headers.emplace_back(1, 1);
      headers.back().setName(part[0]);
      headers.back().setType(Imf::SCANLINEIMAGE);
      for (std::size_t k = 1; k < part.size(); ++k)
        headers.back().channels().insert(part[k], Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile file_of_parts(file.c_str(), headers.data(), int(headers.size()));
    float value = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Imf::FrameBuffer pixels;
      std::vector<float> values(parts[p].size());
      for (std::size_t k = 1; k < parts[p].size(); ++k) {
        values[k] = ++value;
        pixels.insert(parts[p][k], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&values[k]), sizeof(float),
                                              sizeof(float)));
      }
      Imf::OutputPart output(file_of_parts, int(p));
      output.setFrameBuffer(pixels);
      output.writePixels(1);
    }
  }
  std::vector<float> color(const std::string& layer = "") const { return pixel(read({false, layer}), 0); }
};

TEST_F(ExrColors, NamesOfChannels) {
  write({"R", "G", "B", "A", "Z"});
  EXPECT_THAT(color(), ElementsAre(1, 2, 3));
  write({"red", "Green", "BLUE"});
  EXPECT_THAT(color(), ElementsAre(1, 2, 3));
  write({"A", "Y"});
  EXPECT_THAT(color(), ElementsAre(2, 2, 2));
  write({"density"});
  EXPECT_THAT(color(), ElementsAre(1, 1, 1));
  write({"N.X", "N.Y", "N.Z"});
  EXPECT_THAT(error(), AllOf(HasSubstr("has no colours"), HasSubstr("it has: N.X, N.Y, N.Z")));
  EXPECT_THAT(color("N.Z"), ElementsAre(3, 3, 3));
}

TEST_F(ExrColors, LayersAreAskedForByName) {
  write(
      {"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B", "light.lamp.R", "light.lamp.G", "light.lamp.B"});
  EXPECT_THAT(color(), ElementsAre(1, 2, 3));
  EXPECT_THAT(color("diffuse"), ElementsAre(4, 5, 6));
  EXPECT_THAT(color("light.lamp"), ElementsAre(7, 8, 9));
  EXPECT_THAT(error({false, "difuse"}),
              AllOf(HasSubstr("has no layer 'difuse'"), HasSubstr("did you mean 'diffuse'?")));
  write({"beauty.R", "beauty.G", "beauty.B", "depth.Z"});
  EXPECT_THAT(color(), ElementsAre(1, 2, 3));  // There is no other.
  write({"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"});
  EXPECT_THAT(error(), AllOf(HasSubstr("has several layers"), HasSubstr("known: a, b")));
  write({"R", "G", "B"});
  EXPECT_THAT(error({false, "a"}), HasSubstr("leave 'layer' out"));
}

TEST_F(ExrColors, PartsAreLayers) {
  write_parts({{"left", "R", "G", "B"},
               {"right", "R", "G", "B"},
               {"passes", "glow.R", "glow.G", "glow.B"},
               {"depth", "Z"}});
  EXPECT_THAT(color("right"), ElementsAre(4, 5, 6));
  EXPECT_THAT(color("passes.glow"), ElementsAre(7, 8, 9));
  EXPECT_THAT(error(), AllOf(HasSubstr("has several layers"), HasSubstr("known: left, right, passes.glow")));
  write_parts({{"depth", "Z"}, {"picture", "picture.R", "picture.G", "picture.B"}});
  EXPECT_THAT(color(), ElementsAre(2, 3, 4));
  EXPECT_THAT(color("picture"), ElementsAre(2, 3, 4));
}

TEST_F(ExrColors, OtherPrimariesBecomeThoseOfRec709) {
  Imf::Header header(1, 1);
  Imf::addChromaticities(header, {{0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.329f}});
  write({"G", "B", "R"}, header);  // Red 3, green 1, blue 2; ITU-R BT.2087, table 2 backwards.
  const std::vector<float> rgb = color();
  EXPECT_NEAR(rgb[0], 3 * 1.6605 - 0.5876 - 2 * 0.0728, 1e-3);
  EXPECT_NEAR(rgb[1], -3 * 0.1246 + 1.1329 - 2 * 0.0083, 1e-3);
  EXPECT_NEAR(rgb[2], -3 * 0.0182 - 0.1006 + 2 * 1.1187, 1e-3);
  EXPECT_THAT(pixel(read({true, ""}), 0), ElementsAre(3, 1, 2));
  // AP0 of ACES, whose white is near D60: white stays white.
  Imf::addChromaticities(header, {{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}});
  write({"Y"}, header);
  EXPECT_THAT(color(), ElementsAre(1, 1, 1));
  // S-2014-004, AP0 to Rec. 709 by Bradford: 2.5216 -1.1341 -0.3876.
  write({"R", "B", "G"}, header);  // 1 3 2
  EXPECT_NEAR(color()[0], std::max(0.0, 2.5216 - 3 * 1.1341 - 2 * 0.3876), 1e-3);
  write({"B", "G", "R"}, header);  // 3 2 1
  EXPECT_NEAR(color()[0], 3 * 2.5216 - 2 * 1.1341 - 0.3876, 5e-3);
  Imf::addChromaticities(header, {{0.1f, 0.1f}, {0.2f, 0.2f}, {0.3f, 0.3f}, {0.3127f, 0.329f}});
  write({"R", "G", "B"}, header);
  EXPECT_THAT(error(), HasSubstr("its primaries lie on a line"));
}

TEST_F(ExrColors, LuminanceAndChroma) {
  const Imf::Rgba stored(0.5f, 0.25f, 0.125f);
  const std::vector<Imf::Rgba> pixels(8 * 6, stored);
  Imf::Header header({{0, 0}, {9, 7}}, {{2, 2}, {9, 7}});
  {
    Imf::RgbaOutputFile output(file.c_str(), header, Imf::WRITE_YC);
    output.setFrameBuffer(pixels.data() - 2 - 2 * 8, 1, 8);
    output.writePixels(6);
  }
  const ColorImage image = read();
  EXPECT_EQ(image.width, 10);
  EXPECT_EQ(image.height, 8);
  EXPECT_THAT(pixel(image, 2 * 10 + 1), ElementsAre(0, 0, 0));
  EXPECT_NEAR(pixel(image, 44)[0], 0.5, 0.005);
  EXPECT_NEAR(pixel(image, 44)[1], 0.25, 0.005);
  EXPECT_NEAR(pixel(image, 44)[2], 0.125, 0.005);
  EXPECT_THAT(test::error_of([&] { read_exr(file); }), HasSubstr("its channel BY is subsampled (2 x 2)"));
}

TEST_F(ExrColors, CubeMapsAreToldApart) {
  Imf::Header header(1, 1);
  write({"R", "G", "B"}, header);
  EXPECT_FALSE(read().is_cube_map);
  Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
  write({"R", "G", "B"}, header);
  EXPECT_FALSE(read().is_cube_map);
  Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
  write({"R", "G", "B"}, header);
  EXPECT_TRUE(read().is_cube_map);
}

TEST_F(ExrColors, BadFilesAreErrors) {
  write_parts({{"depth", "Z"}, {"left", "left.R", "left.G", "left.B"}});
  expect_bad_files_are_errors();
  Imf::Header header({{0, 0}, {9, 7}}, {{2, 2}, {9, 7}});
  Imf::addChromaticities(header, {{0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.329f}});
  const std::vector<Imf::Rgba> pixels(8 * 6);
  {
    Imf::RgbaOutputFile output(file.c_str(), header, Imf::WRITE_YC);
    output.setFrameBuffer(pixels.data() - 2 - 2 * 8, 1, 8);
    output.writePixels(6);
  }
  expect_bad_files_are_errors();
}

TEST_F(ExrColors, DeepPartsAreRefused) {
  Imf::Header header(1, 1);
  header.setName("deep");
  header.setType(Imf::DEEPSCANLINE);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.compression() = Imf::ZIPS_COMPRESSION;
  {
    Imf::MultiPartOutputFile output(file.c_str(), &header, 1);
    Imf::DeepScanLineOutputPart part(output, 0);
  }
  EXPECT_THAT(error(), HasSubstr("deep images are not supported"));
}

}  // namespace
}  // namespace etendue

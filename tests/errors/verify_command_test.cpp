// `etendue verify`: another renderer's image, right and wrong; what it says when it is interrupted.
//
// False-alarm rate of this file: about 1e-5 (some 10 right images at a level of 1e-6), fixed seeds. Seen to
// fail when: variances of one sample are not divided by their number, mishaps are told by the image itself,
// NaN pixels are kept, an interrupted run writes no JSON.
#include "image/color_space.h"
#include "image/image_file.h"
#include "support/program.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace etendue::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr int image_width = 48, image_height = 32, samples = 256;

std::string scene_xml(int times_larger) {
  return "<scene>\n<integrator type=\"mis\"/><camera type=\"perspective\"><integer name=\"width\" value=\"" +
         std::to_string(image_width * times_larger) + "\"/><integer name=\"height\" value=\"" +
         std::to_string(image_height * times_larger) +
         "\"/><float name=\"fov\" value=\"40\"/><transform name=\"toWorld\"><lookat origin=\"0 -2 5\" "
         "target=\"0 0 0\" up=\"0 1 0\"/></transform></camera>\n"
         "<shape type=\"rectangle\"><transform name=\"toWorld\"><scale value=\"3 3 1\"/></transform><bsdf "
         "type=\"diffuse\"><color name=\"albedo\" value=\"0.6 0.4 0.3\"/></bsdf></shape>\n"
         "<shape type=\"sphere\"><point name=\"center\" value=\"0.7 0.5 0.4\"/><float name=\"radius\" "
         "value=\"0.4\"/><bsdf type=\"diffuse\"><color name=\"albedo\" value=\"0.1 0.2 "
         "0.5\"/></bsdf></shape>\n"
         "<shape type=\"sphere\"><point name=\"center\" value=\"-3 2 2.5\"/><float name=\"radius\" "
         "value=\"0.5\"/><emitter type=\"area\"><color name=\"radiance\" value=\"9 8 "
         "7\"/></emitter></shape>\n"
         "</scene>\n";
}

class VerifyCommand : public testing::Test {
 protected:
  VerifyCommand() {
    write_file(path("scene.xml"), scene_xml(1));
    run_program({"render", "scene.xml", "-o", "a.exr", "--integrator", "direct_light", "--seed", "7", "--spp",
                 std::to_string(samples), "--quiet"},
                folder_.path());
    sound_ = read_exr(path("a.exr"));
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  ProgramResult verify(const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{"verify", "scene.xml", "--spp",  "128",    "--level",
                                       "1e-6",   "--json",    "r.json", "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_program(arguments, folder_.path());
  }
  ProgramResult verify_against(const Image& image, const std::vector<std::string>& options = {}) const {
    write_exr(path("b.exr"), image);
    std::vector<std::string> all{"--integrators", "mis", "--against", "b.exr"};
    all.insert(all.end(), options.begin(), options.end());
    return verify(all);
  }
  nlohmann::json report() const { return nlohmann::json::parse(read_file(path("r.json"))); }

  /// R, G and B alone.
  Image colors() const {
    Image image{image_width, image_height, {}, {}};
    for (const char* name : {"R", "G", "B"}) image.channels.push_back(*sound_.find(name));
    return image;
  }
  /// Each pixel from one of `image`, or of several.
  static Image made(const Image& image, const std::function<float(const Channel&, int, int)>& value) {
    Image other = image;
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      for (int y = 0; y < image_height; ++y)
        for (int x = 0; x < image_width; ++x)
          other.channels[c].values[std::size_t(y * image_width + x)] = value(image.channels[c], x, y);
    return other;
  }
  static float at(const Channel& channel, int x, int y) {
    x = std::clamp(x, 0, image_width - 1), y = std::clamp(y, 0, image_height - 1);
    return channel.values[std::size_t(y * image_width + x)];
  }
  /// With layers made from the standard errors.
  Image with_layer(const std::string& layer,
                   const std::function<float(float error, float mean)>& value) const {
    Image image = colors();
    for (const std::string color : {"R", "G", "B"}) {
      Channel channel{layer + "." + color, {}};
      for (std::size_t k = 0; k < std::size_t(image_width * image_height); ++k)
        channel.values.push_back(
            value(sound_.find("stderr." + color)->values[k], sound_.find(color)->values[k]));
      image.channels.push_back(channel);
    }
    return image;
  }

  const TemporaryFolder folder_;
  Image sound_;
};

TEST_F(VerifyCommand, ARightImageAgreesWhereverItsNoiseIsFrom) {
  struct Case {
    Image image;
    std::string said;
    std::vector<std::string> options{};
  };
  const auto variance = [](float error, float) { return error * error; };
  const auto of_sample = [](float error, float) { return samples * error * error; };
  const auto second_moment = [](float error, float mean) { return samples * error * error + mean * mean; };
  const std::vector<std::string> spp{"--against-spp", std::to_string(samples)};
  for (const Case& each :
       {Case{sound_, "of its layer stderr"}, Case{colors(), "estimated from how neighbouring pixels differ"},
        Case{with_layer("variance", variance), "of its layer variance"},
        Case{with_layer("Variance", of_sample), "of its layer Variance", spp},
        Case{with_layer("m2_nested", second_moment), "of its layer m2_nested", spp},
        Case{with_layer("Variance", of_sample), "--against-spp"}}) {
    const ProgramResult result = verify_against(each.image, each.options);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_THAT(result.out, HasSubstr(each.said));
    EXPECT_THAT(result.err, IsEmpty());
    EXPECT_EQ(report().at("agree"), true);
    EXPECT_TRUE(report().at("mishap").is_null());
  }
}

/// That it is the number of samples that counts.
TEST_F(VerifyCommand, TheVarianceOfOneSampleIsDividedByTheirNumber) {
  const auto of_sample = [](float error, float) { return samples * error * error; };
  const auto error_of = [&](const std::string& spp) {
    verify_against(with_layer("Variance", of_sample), {"--against-spp", spp});
    return report().at("estimators").back().at("stderr").get<double>();
  };
  verify_against(sound_);
  const double known = report().at("estimators").back().at("stderr").get<double>();
  EXPECT_NEAR(error_of("256"), known, 1e-5 * known);
  EXPECT_NEAR(error_of("64"), 2 * known, 1e-5 * known);
}

TEST_F(VerifyCommand, NamesWhatWasDoneToAnImage) {
  const auto linear = [](float v) { return float(linear_from_srgb(v)); };
  const auto srgb = [](float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  };
  struct Case {
    std::string said;
    std::function<float(const Channel&, int, int)> value;
  };
  const Case cases[]{
      {"it is upside down", [](const Channel& c, int x, int y) { return at(c, x, image_height - 1 - y); }},
      {"it is a mirror image, left for right",
       [](const Channel& c, int x, int y) { return at(c, image_width - 1 - x, y); }},
      {"it is turned by 180 degrees",
       [](const Channel& c, int x, int y) { return at(c, image_width - 1 - x, image_height - 1 - y); }},
      {"its numbers are sRGB, not linear light",
       [&](const Channel& c, int x, int y) { return srgb(at(c, x, y)); }},
      {"it was taken for sRGB and decoded",
       [&](const Channel& c, int x, int y) { return linear(at(c, x, y)); }},
      {"it is 1.3 times as bright everywhere",
       [](const Channel& c, int x, int y) { return 1.3f * at(c, x, y); }},
      {"half a pixel off, by +0.5, +0.5", [](const Channel& c, int x, int y) {
         return (at(c, x, y) + at(c, x + 1, y) + at(c, x, y + 1) + at(c, x + 1, y + 1)) / 4;
       }}};
  for (const Case& each : cases) {
    const ProgramResult result = verify_against(made(colors(), each.value));
    EXPECT_EQ(result.exit_code, 1) << each.said << result.out;
    EXPECT_THAT(result.out, HasSubstr("explained if"));
    EXPECT_THAT(result.out, HasSubstr(each.said));
    EXPECT_THAT(report().at("mishap").get<std::string>(), HasSubstr(each.said));
  }
  // Nothing of the kind: a light more.
  const ProgramResult result = verify_against(
      made(colors(), [](const Channel& c, int x, int y) { return at(c, x, y) + (x > 24 ? 0.2f : 0); }));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, Not(HasSubstr("explained")));
}

TEST_F(VerifyCommand, PixelsThatAreNoNumbersAreLeftOut) {
  Image image = sound_;
  for (const std::size_t k : {5, 77, 200})
    for (Channel& channel : image.channels) channel.values[k] = std::numeric_limits<float>::quiet_NaN();
  const ProgramResult result = verify_against(image);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 of its pixels are left out"));
}

TEST_F(VerifyCommand, AnImageOfAnotherSizeIsBadInput) {
  Image image{image_width - 1, image_height, {}, {}};
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, std::vector<float>(std::size_t((image_width - 1) * image_height), 0.5f)});
  const ProgramResult result = verify_against(image);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("b.exr: 47 x 32 pixels, the scene's image has 48 x 32"));
}

void write_jpeg(const std::filesystem::path& file, const std::vector<unsigned char>& rgb) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  std::FILE* const out = std::fopen(file.c_str(), "wb");
  jpeg_stdio_dest(&jpeg, out);
  jpeg.image_width = image_width, jpeg.image_height = image_height;
  jpeg.input_components = 3, jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < image_height; ++y) {
    JSAMPROW row = const_cast<JSAMPROW>(rgb.data() + std::size_t(3 * y * image_width));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::fclose(out);
  jpeg_destroy_compress(&jpeg);
}

TEST_F(VerifyCommand, FilesOfEightBitsAreTakenAsTheyAre) {
  const Image image = colors();
  const auto write_brighter = [&](float factor) {
    const Image brighter = made(image, [&](const Channel& c, int x, int y) { return factor * at(c, x, y); });
    write_png(path("b.png"), brighter);
    std::vector<unsigned char> rgb;
    for (std::size_t k = 0; k < std::size_t(image_width * image_height); ++k)
      for (const Channel& channel : brighter.channels) {
        const float v = std::clamp(channel.values[k], 0.0f, 1.0f);
        const float srgb = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
        rgb.push_back((unsigned char)(std::lround(255 * srgb)));
      }
    write_jpeg(path("b.jpg"), rgb);
  };
  write_brighter(1);
  for (const char* file : {"b.png", "b.jpg"}) {
    const ProgramResult result = verify({"--integrators", "mis", "--against", file});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }
  write_brighter(1.3f);
  for (const char* file : {"b.png", "b.jpg"}) {
    const ProgramResult result = verify({"--integrators", "mis", "--against", file});
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    EXPECT_THAT(result.out, HasSubstr("times as bright everywhere"));
  }
}

TEST_F(VerifyCommand, InterruptedItSaysWhatItHas) {
  write_file(path("scene.xml"), scene_xml(8));
  Program program({"verify", "scene.xml", "--time", "600", "--json", "r.json"}, folder_.path());
  program.wait_until(
      [&] { return program.err_so_far().find("verify") != std::string::npos || program.seconds() > 1; });
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3) << result.out << result.err;
  EXPECT_THAT(result.err, HasSubstr("estimators were compared"));
  EXPECT_EQ(report().at("is_interrupted"), true);
}

}  // namespace
}  // namespace etendue::test

// --layers and --noise: channels, sums, words.
//
// No test of this file can fail by chance: seeds are fixed, and what is compared is equal but for rounding,
// or far apart. Seen to fail when: films of layers are taken in another order than names; emission counts as
// BSDF samples; shares are of standard errors, not of their squares.
#include "image/image_file.h"
#include "support/program.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int width = 24, height = 18;

/// A red floor at z = 0, seen from 5 above, two lamps of one name, one of another in the picture, and a sky.
const std::string scene =
    "<scene>\n<camera type=\"perspective\"><integer name=\"width\" value=\"24\"/><integer name=\"height\" "
    "value=\"18\"/><transform name=\"toWorld\"><lookat origin=\"0 0 5\" target=\"0 0 0\" up=\"0 1 "
    "0\"/></transform></camera>\n"
    "<shape type=\"rectangle\"><bsdf "
    "type=\"diffuse\"><color name=\"albedo\" value=\"0.6 0.2 0.1\"/></bsdf></shape>\n"
    "<shape type=\"sphere\" name=\"pair\"><point name=\"center\" value=\"3 0 2\"/><float name=\"radius\" "
    "value=\"0.2\"/><emitter type=\"area\"><color name=\"radiance\" value=\"9\"/></emitter></shape>\n"
    "<shape type=\"sphere\" name=\"pair\"><point name=\"center\" value=\"-3 0 2\"/><float name=\"radius\" "
    "value=\"0.3\"/><emitter type=\"area\"><color name=\"radiance\" value=\"9\"/></emitter></shape>\n"
    "<shape type=\"sphere\" name=\"no.3\"><point name=\"center\" value=\"0 0 1\"/><float name=\"radius\" "
    "value=\"0.4\"/><emitter type=\"area\"><color name=\"radiance\" value=\"2\"/></emitter></shape>\n"
    "<emitter type=\"constant\" name=\"sky\"><color name=\"radiance\" value=\"0.3\"/></emitter>\n</scene>\n";

class LayersCommand : public testing::Test {
 protected:
  LayersCommand() { write_file(path("scene.xml"), scene); }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  ProgramResult render(const std::vector<std::string>& options, int samples = 32) const {
    std::vector<std::string> arguments{"render", "scene.xml", "-o",
                                       "a.exr",  "--spp",     std::to_string(samples)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_program(arguments, folder_.path());
  }
  Image image() const { return read_exr(path("a.exr")); }
  const TemporaryFolder folder_;
};

const std::vector<float>& channel(const Image& image, const std::string& name) {
  static const std::vector<float> none(width * height, std::nanf(""));
  const Channel* found = image.find(name);
  EXPECT_NE(found, nullptr) << name;
  return found ? found->values : none;
}

void expect_sum(const Image& image, const std::vector<std::string>& layers) {
  for (const char* color : {".R", ".G", ".B"}) {
    std::vector<float> sum(width * height);
    for (const std::string& layer : layers)
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += channel(image, layer + color)[i];
    const std::vector<float>& whole = channel(image, std::string(1, color[1]));
    for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], whole[i], 1e-5 * (1 + whole[i])) << i;
  }
}

float sum_of(const Image& image, const std::string& name) {
  const std::vector<float>& values = channel(image, name);
  return std::accumulate(values.begin(), values.end(), 0.0f);
}

TEST_F(LayersCommand, PartsOfTheRadianceAddUpToTheImageWithErrors) {
  ASSERT_EQ(render({"--layers", "light,technique,depth", "--integrator", "path_mis"}).exit_code, 0);
  const Image all = image();
  expect_sum(all, {"light.pair", "light.no_3", "light.sky"});
  expect_sum(all, {"emission", "technique.light", "technique.bsdf"});
  expect_sum(all, {"emission", "direct", "indirect.1", "indirect.2", "indirect.3", "indirect.beyond"});
  for (const char* name : {"light.pair", "light.no_3", "light.sky", "emission", "direct", "technique.light",
                           "technique.bsdf", "indirect.1"})
    for (const char* error : {".stderr.R", ".stderr.G", ".stderr.B"})
      EXPECT_GT(sum_of(all, std::string(name) + error), 0) << name << error;
  // The camera sees the lamp in the middle and, around the floor, the sky.
  const std::size_t middle = height / 2 * width + width / 2;
  EXPECT_FLOAT_EQ(channel(all, "emission.R")[middle], 2);
  EXPECT_FLOAT_EQ(channel(all, "light.sky.G")[0], 0.3f);
}

TEST_F(LayersCommand, WithoutThemTheImageHasTheSameBits) {
  ASSERT_EQ(render({"--layers", "light,technique,depth,albedo,id", "--noise"}).exit_code, 0);
  const Image with = image();
  ASSERT_EQ(render({}).exit_code, 0);
  const Image without = image();
  for (const Channel& each : without.channels) EXPECT_EQ(channel(with, each.name), each.values) << each.name;
}

TEST_F(LayersCommand, TellWhatTheCameraSees) {
  ASSERT_EQ(render({"--layers", "position,distance,normal,albedo,id,samples,variance_share"}).exit_code, 0);
  const Image all = image();
  const auto at = [&](int x, int y, const char* name) {
    return channel(all, name)[std::size_t(y * width + x)];
  };
  // fov 30 degrees across 24 pixels; the sphere's top is at z = 1.4.
  const float half_px = 5 * std::tan(15 * 3.14159265f / 180) / width;
  EXPECT_NEAR(at(4, 9, "position.Z"), 0, 1e-5);
  EXPECT_NEAR(std::abs(at(4, 9, "position.X")), 15 * half_px, 1e-3);
  EXPECT_NEAR(std::abs(at(4, 9, "position.Y")), half_px, 1e-3);
  EXPECT_NEAR(at(4, 9, "distance.Z"), std::hypot(5, 15 * half_px, half_px), 1e-3);
  EXPECT_FLOAT_EQ(at(4, 9, "normal.Z"), 1);
  EXPECT_FLOAT_EQ(at(4, 9, "albedo.R"), 0.6f);
  EXPECT_FLOAT_EQ(at(4, 9, "albedo.B"), 0.1f);
  EXPECT_EQ(at(4, 9, "id.shape"), 0);
  EXPECT_EQ(at(4, 9, "id.light"), -1);
  EXPECT_EQ(at(12, 9, "id.shape"), 3);
  EXPECT_EQ(at(12, 9, "id.light"), 2);
  EXPECT_NEAR(at(12, 9, "distance.Z"), 3.6, 0.02);
  EXPECT_EQ(at(0, 0, "id.shape"), -1);
  EXPECT_EQ(at(0, 0, "id.material"), -1);
  EXPECT_TRUE(std::isinf(at(0, 0, "distance.Z")));
  EXPECT_EQ(at(5, 5, "samples.count"), 32);
  EXPECT_NEAR(sum_of(all, "variance_share.Y"), 1, 1e-5);
  EXPECT_EQ(all.find("light.sky.R"), nullptr);
}

TEST_F(LayersCommand, ThatAreUnknownAreRefused) {
  const ProgramResult unknown = render({"--layers", "light,tecnique"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("unknown layer 'tecnique'"),
                                 HasSubstr("did you mean 'technique'?"), HasSubstr("variance_share")));
  EXPECT_EQ(render({"--layers", "light,light"}).exit_code, 2);
  const ProgramResult lightless = render({"--layers", "depth", "--integrator", "normals"});
  EXPECT_EQ(lightless.exit_code, 2);
  EXPECT_THAT(lightless.err, HasSubstr("'normals'"));
  EXPECT_EQ(render({"--noise", "--integrator", "ao"}).exit_code, 2);
  EXPECT_EQ(render({"--layers", "normal", "--integrator", "normals"}).exit_code, 0);
}

TEST_F(LayersCommand, OfManyLightsTheWeakestShareOne) {
  std::string lamps;
  for (int k = 0; k < 40; ++k)
    lamps += "<emitter type=\"point\" name=\"p" + std::to_string(k) +
             "\"><color name=\"intensity\" value=\"" + std::to_string(k == 7 ? 100 : 1 + 0.1 * k) +
             "\"/><point name=\"position\" value=\"0 1 3\"/></emitter>\n";
  std::string many = scene;
  write_file(path("scene.xml"), many.insert(many.find("</scene>"), lamps));
  const ProgramResult result = render({"--layers", "light"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the other 12 are in light.others"));
  const Image all = image();
  EXPECT_NE(all.find("light.p7.R"), nullptr);
  EXPECT_NE(all.find("light.p39.R"), nullptr);
  EXPECT_EQ(all.find("light.p0.R"), nullptr);
  EXPECT_GT(sum_of(all, "light.others.R"), 0);
  std::vector<std::string> layers;
  for (const Channel& each : all.channels)
    if (each.name.starts_with("light.") && each.name.ends_with(".R") && !each.name.ends_with(".stderr.R"))
      layers.push_back(each.name.substr(0, each.name.size() - 2));
  EXPECT_EQ(layers.size(), 32u);
  expect_sum(all, layers);
}

TEST_F(LayersCommand, NoiseIsSharedOutToLightsAndTechniques) {
  const ProgramResult result = render({"--noise", "--stats", "s.json", "--integrator", "mis"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("the variance of the image comes from"),
                                HasSubstr("'pair' by light samples"), Not(HasSubstr("infinite"))));
  const nlohmann::json shares = nlohmann::json::parse(read_file(path("s.json"))).at("variance_share");
  double sum = 0;
  std::vector<std::string> names;
  for (const auto& row : shares) {
    sum += row.at("share").get<double>();
    names.push_back(row.at("light").get<std::string>() + " " + row.at("technique").get<std::string>());
    EXPECT_TRUE(row.contains("tail_slope"));
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_THAT(names, testing::UnorderedElementsAre("pair light", "pair bsdf", "no_3 emission", "no_3 light",
                                                   "no_3 bsdf", "sky emission", "sky light", "sky bsdf"));
  ASSERT_EQ(render({"--stats", "s.json"}).exit_code, 0);
  EXPECT_FALSE(nlohmann::json::parse(read_file(path("s.json"))).contains("variance_share"));
}

TEST_F(LayersCommand, ATechniqueOfInfiniteVarianceIsNamed) {
  // A wall that shines stands on the floor, and a lamp hangs far from both.
  std::string corner = scene;
  const std::string wall =
      "<shape type=\"rectangle\" name=\"wall\"><transform name=\"toWorld\"><rotate axis=\"1 0 0\" "
      "angle=\"90\"/><translate value=\"0 0.9 1\"/></transform><emitter type=\"area\"><color "
      "name=\"radiance\" "
      "value=\"1\"/></emitter></shape>\n";
  write_file(path("scene.xml"), corner.insert(corner.find("</scene>"), wall));
  const auto words = [&](const std::string& integrator, int samples) {
    return render({"--noise", "--integrator", integrator}, samples).err;
  };
  EXPECT_THAT(words("light", 4096),
              AllOf(HasSubstr("'wall' by light samples: the density"), HasSubstr("infinite"),
                    Not(HasSubstr("'pair' by light samples: "))));
  EXPECT_THAT(words("mis", 256), Not(HasSubstr("infinite")));
}

}  // namespace
}  // namespace etendue::test

// What scripts and people rely on: options, files, exit codes.
#include "image/image_file.h"
#include "support/program.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pty.h>
#include <random>

namespace etendue::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A sphere that shines upon a square, seen from above.
std::string scene_xml(int width, int height, const std::string& radiance = "1") {
  return "<scene>\n<camera type=\"perspective\"><integer name=\"width\" value=\"" + std::to_string(width) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(height) +
         "\"/><transform name=\"toWorld\"><lookat origin=\"0 0 4\" target=\"0 0 0\" up=\"0 1 "
         "0\"/></transform></camera>\n"
         "<shape type=\"rectangle\"/>\n"
         "<shape type=\"sphere\" name=\"lamp\"><point name=\"center\" value=\"1 0 0.9\"/><float "
         "name=\"radius\" "
         "value=\"0.8\"/><emitter type=\"area\"><color name=\"radiance\" value=\"" +
         radiance + "\"/></emitter></shape>\n</scene>\n";
}

/// A folder with scene.xml in it.
class CommandLine : public testing::Test {
 protected:
  CommandLine() { write_file(path("scene.xml"), scene_xml(40, 30)); }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  ProgramResult run(const std::vector<std::string>& arguments) const {
    return run_program(arguments, folder_.path());
  }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(read_file(path(name))); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    return names;
  }
  const TemporaryFolder folder_;
};

std::string metadata(const Image& image, const std::string& name) {
  for (const auto& [key, value] : image.metadata)
    if (key == name) return value;
  return "(none)";
}

TEST_F(CommandLine, LintSaysWhatIsOddAsJsonToo) {
  const ProgramResult good = run({"lint", "scene.xml", "--json", "good.json"});
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  EXPECT_TRUE(nlohmann::json::parse(read_file(path("good.json")))["findings"].empty());
  write_file(path("black.xml"), scene_xml(40, 30, "0"));
  EXPECT_EQ(run({"lint", "black.xml", "--json", "black.json"}).exit_code, 1);
  const auto findings = nlohmann::json::parse(read_file(path("black.json")))["findings"];
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0]["id"], "light-black");
  EXPECT_EQ(findings[0]["severity"], "doubtful");
  EXPECT_EQ(findings[0]["file"], "black.xml");
  EXPECT_EQ(findings[0]["line"], 4);
  EXPECT_EQ(run({"lint", "scene.xml", "--json", "scene.xml"}).exit_code, 2);
  EXPECT_EQ(run({"lint", "nowhere.xml"}).exit_code, 2);
}

TEST_F(CommandLine, HelpOfRenderNamesEveryOption) {
  const ProgramResult help = run({"render", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* name :
       {"SCENE",        "-o,--output",   "--integrator", "--sampler", "--light-sampler", "--technique",
        "--candidates", "--shadow-rays", "--weights",    "--spp",     "--replicates",    "--replicates-by",
        "--seed",       "--threads",     "--isa",        "--stats",   "--quiet",         "--strict",
        "--dialect",    "--replay",      "--layers",     "--noise"})
    EXPECT_THAT(help.out, HasSubstr(name));
}

TEST_F(CommandLine, HelpNamesEveryCommand) {
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("render"), HasSubstr("info")));
  EXPECT_THAT(run({"info", "--help"}).out, HasSubstr("--json"));
  EXPECT_EQ(run({"--version"}).exit_code, 0);
}

TEST_F(CommandLine, QuietSaysNothing) {
  const ProgramResult result = run({"render", "scene.xml", "-o", "a.exr", "--spp", "4", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(CommandLine, MoreThreadsThanProcessorsAreNoMatter) {
  const std::string threads = std::to_string(3 * std::thread::hardware_concurrency());
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--sample-order"}}) {
    std::vector<std::string> arguments{"render", "scene.xml", "-o", "a.exr", "--quiet", "--threads", threads};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out + result.err, IsEmpty());
  }
}

/// A line that is full would be wrapped, and what is written over it would go to a new one.
TEST_F(CommandLine, TheProgressBarFitsTheTerminal) {
  write_file(path("scene.xml"), scene_xml(200, 200));
  for (const unsigned short columns : {120, 64, 40, 20, 8}) {
    int terminal = -1, end = -1;
    const winsize size{24, columns, 0, 0};
    ASSERT_EQ(openpty(&terminal, &end, nullptr, nullptr, &size), 0);
    Program program(
        {"render", "scene.xml", "-o", "a.exr", "--threads", "1", "--isa", "scalar", "--spp", "64"},
        folder_.path(), end);
    close(end);
    std::string seen;
    char buffer[4096];
    for (ssize_t count; (count = read(terminal, buffer, sizeof buffer)) > 0;)
      seen.append(buffer, std::size_t(count));
    close(terminal);
    EXPECT_EQ(program.wait().exit_code, 0);
    // Of the pieces between line feeds and carriage returns, those that are of the bar end by clearing the
    // line.
    int updates = 0;
    for (std::size_t begin = 0; (begin = seen.find('\r', begin)) != std::string::npos;) {
      const std::size_t stop = seen.find_first_of("\r\n\x1b", ++begin);
      if (stop == std::string::npos || seen.compare(stop, 3, "\x1b[K") != 0) continue;
      EXPECT_LT(stop - begin, columns) << seen.substr(begin, stop - begin);
      updates += stop > begin;
    }
    EXPECT_GT(updates, 0) << columns;
  }
}

TEST_F(CommandLine, WritesEveryOutput) {
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "-o", "a.png", "--spp", "8", "--seed", "5"}).exit_code,
            0);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("scene.xml", "a.exr", "a.png"));
  EXPECT_EQ(read_file(path("a.png")).substr(1, 3), "PNG");
  const Image image = read_exr(path("a.exr"));
  EXPECT_EQ(image.width, 40);
  EXPECT_EQ(image.height, 30);
  for (const char* name : {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B", "stderr.Y", "interval.R",
                           "interval.G", "interval.B", "interval.Y", "interval.trust"}) {
    const Channel* channel = image.find(name);
    ASSERT_TRUE(channel) << name;
    for (const float value : channel->values) ASSERT_GE(value, 0) << name;  // NaN fails too
  }
  EXPECT_EQ(metadata(image, "seed"), "5");
  EXPECT_EQ(metadata(image, "replicates"), "0-7");
  EXPECT_EQ(metadata(image, "samplesPerPixel"), "8");
  EXPECT_EQ(metadata(image, "integrator"), "path");
  EXPECT_THAT(metadata(image, "software"), HasSubstr("Etendue"));
  EXPECT_EQ(metadata(image, "sceneHash").size(), 16u);
}

TEST_F(CommandLine, SaysErrorsOfImageAndRegions) {
  const ProgramResult result =
      run({"render", "scene.xml", "-o", "a.exr", "--spp", "32", "--confidence", "0.9", "--region",
           "left=0,0,20,30", "--region", "right=20,0,40,30", "--stats", "s.json"});
  ASSERT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("90 % intervals: "));
  EXPECT_THAT(result.err, HasSubstr("right: mean luminance "));
  const nlohmann::json stats = json("s.json"), regions = stats.at("regions");
  EXPECT_EQ(stats.at("error").at("confidence"), 0.9);
  double shares = 0;
  for (const auto& share : stats.at("error").at("trust")) shares += share.get<double>();
  EXPECT_NEAR(shares, 1, 1e-12);
  const auto green = [&](const char* region, const char* what) {
    return regions.at(region).at(what).at(1).get<double>();
  };
  EXPECT_NEAR(green("image", "mean"), stats.at("mean").at(1).get<double>(), 1e-12);
  EXPECT_NEAR(green("image", "mean"), 0.5 * (green("left", "mean") + green("right", "mean")), 1e-9);
  EXPECT_LT(green("left", "low"), green("left", "mean"));
  EXPECT_GT(green("left", "high"), green("left", "mean"));
  EXPECT_LT(stats.at("checks").at("image").at("rise_by_largest").get<double>(), 1);
}

TEST_F(CommandLine, AGoalIsReachedByAnImageThatASampleCountGivesToo) {
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.png", "--error", "0.2", "--of", "0.5", "--spp", "512",
                 "--stats", "s.json", "--quiet"})
                .exit_code,
            0);
  const nlohmann::json stats = json("s.json");
  EXPECT_GT(stats.at("error").at("goal").at("reached").get<double>(), 0.3);
  const std::string samples = std::to_string(stats.at("spp").get<int>());
  ASSERT_EQ(run({"render", "scene.xml", "-o", "b.png", "--spp", samples, "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_file(path("a.png")), read_file(path("b.png")));
}

TEST_F(CommandLine, AGoalIsReachedByWhatEachPixelNeeds) {
  const std::vector<std::string> command{"render",    "scene.xml",  "-o",         "a.exr",    "--error",
                                         "0.2",       "--of",       "0.5",        "--spp",    "512",
                                         "--stats",   "s.json",     "--adaptive", "--layers", "samples",
                                         "--sampler", "independent"};
  const ProgramResult first = run(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, AllOf(HasSubstr("pilots find out how many samples each pixel takes"),
                               HasSubstr(" samples a pixel, "), HasSubstr(" on average\n")));
  const nlohmann::json stats = json("s.json"), adaptive = stats.at("adaptive");
  EXPECT_GT(stats.at("error").at("goal").at("reached").get<double>(), 0.3);
  EXPECT_LT(adaptive.at("least_samples_per_pixel").get<int>(),
            adaptive.at("most_samples_per_pixel").get<int>());
  EXPECT_NEAR(adaptive.at("mean_samples_per_pixel").get<double>(), stats.at("spp").get<double>(), 0.5);
  EXPECT_GE(adaptive.at("pilot_samples_per_pixel").get<int>(), 32);
  const std::string image = read_file(path("a.exr"));
  ASSERT_EQ(run(command).exit_code, 0);  // The same command, the same bits.
  EXPECT_EQ(read_file(path("a.exr")), image);
}

TEST_F(CommandLine, TheMostOfAnErrorIsAnAverageWherePixelsDiffer) {
  const ProgramResult result = run({"render", "scene.xml", "-o", "a.png", "--error", "1e-3", "--spp", "32",
                                    "--stats", "s.json", "--adaptive", "--sampler", "independent"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("the most there may be: what was asked for is not reached"));
  EXPECT_LE(json("s.json").at("adaptive").at("mean_samples_per_pixel").get<double>(), 32);
  EXPECT_EQ(
      run({"render", "scene.xml", "-o", "a.png", "--error", "0.1", "--spp", "8", "--adaptive"}).exit_code, 2);
}

TEST_F(CommandLine, StatsHaveTheirKeys) {
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "--spp", "8", "--integrator", "mis", "--sampler",
                 "sobol", "--seed", "3", "--threads", "2", "--isa", "scalar", "--stats", "s.json", "--quiet"})
                .exit_code,
            0);
  const nlohmann::json stats = json("s.json");
  EXPECT_EQ(stats.at("scene"), "scene.xml");
  EXPECT_EQ(stats.at("integrator"), "mis");
  EXPECT_EQ(stats.at("sampler"), "sobol");
  EXPECT_EQ(stats.at("isa"), "scalar");
  EXPECT_EQ(stats.at("spp"), 8);
  EXPECT_EQ(stats.at("replicates"), 8);
  EXPECT_EQ(stats.at("replicates_by"), "block");
  EXPECT_EQ(stats.at("interrupted"), false);
  EXPECT_EQ(stats.at("seed"), 3);
  EXPECT_EQ(stats.at("threads"), 2);
  EXPECT_EQ(stats.at("width"), 40);
  EXPECT_EQ(stats.at("height"), 30);
  EXPECT_EQ(stats.at("samples"), 40 * 30 * 8);
  EXPECT_EQ(stats.at("camera_rays"), 40 * 30 * 8);
  EXPECT_EQ(stats.at("triangles"), 2);
  EXPECT_EQ(stats.at("lights"), 1);
  EXPECT_EQ(stats.at("invalid_samples"), 0);
  EXPECT_EQ(stats.at("pixels_not_rendered"), 0);
  for (const char* key : {"shadow_rays", "bsdf_rays", "peak_memory_bytes"}) {
    EXPECT_TRUE(stats.at(key).is_number_integer()) << key;
    EXPECT_GT(stats.at(key), 0) << key;
  }
  for (const char* key :
       {"seconds_load", "seconds_build", "seconds_render", "samples_per_second", "mean_luminance"}) {
    EXPECT_TRUE(stats.at(key).is_number_float()) << key;
    EXPECT_GE(stats.at(key), 0) << key;
  }
  ASSERT_EQ(stats.at("mean").size(), 3u);
  for (const auto& channel : stats.at("mean")) EXPECT_GT(channel, 0);
}

TEST_F(CommandLine, HowLightsAreSampledStandsInTheStats) {
  const auto stats_with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command{"render", "scene.xml", "-o",     "a.exr",  "--spp",
                                     "2",      "--stats",   "s.json", "--quiet"};
    command.insert(command.end(), options.begin(), options.end());
    const ProgramResult result = run(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json("s.json");
  };
  const auto expect = [](const nlohmann::json& stats, const std::string& integrator,
                         const std::string& light_sampler, const std::string& technique, int light_samples,
                         int candidates, int glossy_candidates) {
    EXPECT_EQ(stats.at("integrator"), integrator);
    EXPECT_EQ(stats.at("light_sampler"), light_sampler) << integrator;
    EXPECT_EQ(stats.at("technique"), technique) << integrator;
    EXPECT_EQ(stats.at("light_samples"), light_samples) << integrator;
    EXPECT_EQ(stats.at("candidates"), candidates) << integrator;
    EXPECT_EQ(stats.at("glossy_candidates"), glossy_candidates) << integrator;
  };
  // The scene names no integrator.
  const nlohmann::json plain = stats_with({});
  expect(plain, "path", "tree", "auto", 1, 1, 4);
  EXPECT_EQ(plain.at("heuristic"), "power");
  expect(stats_with({"--integrator", "direct_light"}), "direct_light", "tree", "auto", 4, 1, 4);
  expect(stats_with({"--integrator", "light"}), "light", "uniform", "area", 1, 1, 1);
  expect(stats_with({"--integrator", "direct"}), "direct", "", "", 0, 0, 0);
  const nlohmann::json asked =
      stats_with({"--integrator", "mis", "--light-sampler", "power", "--technique", "solid_angle",
                  "--shadow-rays", "3", "--candidates", "5", "--weights", "power"});
  expect(asked, "mis", "power", "solid_angle", 3, 5, 5);
  EXPECT_EQ(asked.at("heuristic"), "power");
  const nlohmann::json one = stats_with({"--integrator", "light"}),
                       three = stats_with({"--integrator", "light", "--shadow-rays", "3"});
  EXPECT_EQ(three.at("camera_rays"), one.at("camera_rays"));
  EXPECT_GT(three.at("shadow_rays"), 2 * one.at("shadow_rays").get<int>());
  const nlohmann::json path = stats_with({"--bsdf-samples", "1"}),
                       paths = stats_with({"--bsdf-samples", "4"});
  EXPECT_EQ(plain.at("bsdf_samples"), 1);
  EXPECT_EQ(one.at("bsdf_samples"), 0);
  EXPECT_EQ(paths.at("bsdf_samples"), 4);
  EXPECT_EQ(paths.at("camera_rays"), path.at("camera_rays"));
  EXPECT_GT(paths.at("bsdf_rays"), 3 * path.at("bsdf_rays").get<int>());
  EXPECT_EQ(run({"lint", "scene.xml", "--light-sampler", "power", "--candidates", "5"}).exit_code, 0);
  EXPECT_EQ(run({"lint", "scene.xml", "--integrator", "direct", "--shadow-rays", "5"}).exit_code, 2);
}

TEST_F(CommandLine, WeightsOverrideTheFilesHeuristic) {
  write_file(path("scene.xml"),
             "<scene><integrator type=\"mis\"><string name=\"heuristic\" value=\"power\"/></integrator>" +
                 scene_xml(4, 4).substr(7));
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "--stats", "s.json"}).exit_code, 0);
  EXPECT_EQ(json("s.json").at("heuristic"), "power");
  ASSERT_EQ(
      run({"render", "scene.xml", "-o", "a.exr", "--stats", "s.json", "--weights", "balance"}).exit_code, 0);
  EXPECT_EQ(json("s.json").at("heuristic"), "balance");
}

TEST_F(CommandLine, InfoListsEveryPluginWithItsParameters) {
  const ProgramResult result = run({"info", "--json"});
  ASSERT_EQ(result.exit_code, 0);
  const nlohmann::json info = nlohmann::json::parse(result.out);
  EXPECT_TRUE(info.at("version").is_string());
  EXPECT_FALSE(info.at("instruction_sets").empty());
  EXPECT_FALSE(info.at("dependencies").empty());
  for (const char* family : {"integrators", "samplers", "cameras", "filters", "shapes", "bsdfs", "lights"}) {
    ASSERT_FALSE(info.at(family).empty()) << family;
    for (const auto& plugin : info.at(family)) {
      EXPECT_FALSE(plugin.at("name").get<std::string>().empty()) << family;
      EXPECT_FALSE(plugin.at("meaning").get<std::string>().empty()) << plugin.at("name");
      for (const auto& parameter : plugin.at("parameters")) {
        EXPECT_FALSE(parameter.at("meaning").get<std::string>().empty()) << parameter;
        EXPECT_TRUE(parameter.at("is_required").is_boolean()) << parameter;
        EXPECT_TRUE(parameter.contains("type") && parameter.contains("default") &&
                    parameter.contains("unit"));
      }
    }
  }
  for (const auto& integrator : info.at("integrators"))
    if (integrator.at("name") == "mipath") {
      EXPECT_EQ(integrator.at("by_default"),
                "path_mis heuristic=balance light_samples=1 sampler=uniform bsdf_samples=1");
    }
  for (const char* name : {"light", "technique", "depth", "position", "distance", "normal", "albedo", "id",
                           "samples", "variance_share"})
    EXPECT_TRUE(std::any_of(info.at("layers").begin(), info.at("layers").end(),
                            [&](const nlohmann::json& layer) {
                              return layer.at("name") == name &&
                                     !layer.at("meaning").get<std::string>().empty();
                            }))
        << name;
  const ProgramResult text = run({"info"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("\n  variance_share: "));
}

TEST_F(CommandLine, ProgressWithoutATerminalIsAtMostALineASecond) {
  write_file(path("scene.xml"), scene_xml(256, 256));
  const ProgramResult result = run({"render", "scene.xml", "-o", "a.exr", "--spp", "150", "--threads", "1",
                                    "--isa", "scalar", "--integrator", "light"});
  ASSERT_EQ(result.exit_code, 0);
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = result.err.find("render: ", at)) != std::string::npos; ++at) ++lines;
  EXPECT_LE(double(lines), result.seconds);
  EXPECT_THAT(result.err, Not(HasSubstr("\r")));
}

/// The pixels that have no radiance and no error; NaN as an error of one with radiance does not count.
std::int64_t count_not_rendered(const Image& image) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < image.find("R")->values.size(); ++i)
    count += std::isnan(image.find("stderr.R")->values[i]) && image.find("R")->values[i] == 0;
  return count;
}

bool same_pixels(const Image& a, const Image& b) {
  for (const Channel& channel : a.channels) {
    const std::vector<float>&x = channel.values, &y = b.find(channel.name)->values;
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) != 0) return false;
  }
  return a.channels.size() == b.channels.size();
}

/// Longer than any test waits, in replicates that take a fraction of a second.
const std::vector<std::string> long_render{
    "render",       "scene.xml", "-o",        "a.exr", "--stats",   "s.json", "--spp",        "409600000",
    "--replicates", "4096000",   "--threads", "1",     "--sampler", "sobol",  "--integrator", "light"};

TEST_F(CommandLine, AnInterruptLeavesTheWholeImageOfFewerReplicates) {
  for (const std::string by : {"block", "scrambling"}) {
    std::filesystem::remove(path("a.exr"));
    std::vector<std::string> command = long_render;
    command.insert(command.end(), {"--replicates-by", by});
    Program program(command, folder_.path());
    program.wait_until([&] { return program.err_so_far().find("render: ") != std::string::npos; });
    program.send(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, AllOf(HasSubstr("interrupted"), HasSubstr("saved the whole image ("),
                                  HasSubstr(" of 4096000 replicates"), HasSubstr("to a.exr"),
                                  Not(HasSubstr("kept as it was")), Not(HasSubstr("partial"))));
    const Image image = read_exr(path("a.exr"));
    EXPECT_EQ(count_not_rendered(image), 0);
    EXPECT_EQ(metadata(image, "pixelsNotRendered"), "(none)");
    const int replicates = json("s.json").at("replicates"), samples = json("s.json").at("spp");
    ASSERT_GT(replicates, 1);
    EXPECT_EQ(samples, 100 * replicates);
    EXPECT_EQ(json("s.json").at("interrupted"), true);
    EXPECT_EQ(json("s.json").at("samples"), 40 * 30 * samples);
    EXPECT_EQ(metadata(image, "replicates"), "0-" + std::to_string(replicates - 1));
    EXPECT_EQ(metadata(image, "samplesPerPixel"), std::to_string(samples));
    EXPECT_EQ(metadata(image, "replicatesBy"), by);
    ASSERT_EQ(
        run({"render", "scene.xml", "-o", "b.exr", "--integrator", "light", "--spp", std::to_string(samples),
             "--replicates", std::to_string(replicates), "--replicates-by", by, "--sampler", "sobol"})
            .exit_code,
        0);
    EXPECT_TRUE(same_pixels(image, read_exr(path("b.exr"))));
  }
}

TEST_F(CommandLine, AnInterruptedImageDoesNotReplaceAFinishedOne) {
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "--spp", "8"}).exit_code, 0);
  const std::string finished = read_file(path("a.exr"));
  Program program(long_render, folder_.path());
  program.wait_until([&] { return program.err_so_far().find("render: ") != std::string::npos; });
  program.send(SIGTERM);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("to a.partial.exr"), HasSubstr("a.exr is kept as it was")));
  EXPECT_EQ(read_file(path("a.exr")), finished);
  EXPECT_EQ(count_not_rendered(read_exr(path("a.partial.exr"))), 0);
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "--spp", "16"}).exit_code, 0);
  EXPECT_NE(read_file(path("a.exr")), finished);
  EXPECT_TRUE(std::filesystem::exists(path("a.partial.exr")));
}

TEST_F(CommandLine, AFragmentGoesToAPartialNameOfItsOwn) {
  write_file(path("scene.xml"), scene_xml(512, 512));
  write_file(path("s.json"), "of a finished render");
  // A replicate of every pixel takes minutes.
  Program program({"render", "scene.xml", "-o", "a.exr", "-o", "a.png", "--stats", "s.json", "--spp", "40000",
                   "--replicates", "2", "--threads", "1", "--isa", "scalar", "--integrator", "light"},
                  folder_.path());
  program.wait_until([&] { return program.err_so_far().find("render: ") != std::string::npos; });
  program.send(SIGHUP);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("pixels (of these 1 of 2 replicates"),
                                HasSubstr("to a.partial.exr, a.partial.png"), HasSubstr("to s.partial.json"),
                                HasSubstr("s.json is kept as it was"), Not(HasSubstr("a.exr is kept"))));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("scene.xml", "a.partial.exr", "a.partial.png", "s.json",
                                                     "s.partial.json"));
  EXPECT_EQ(read_file(path("s.json")), "of a finished render");
  const Image image = read_exr(path("a.partial.exr"));
  const std::int64_t unknown = json("s.partial.json").at("pixels_not_rendered");
  EXPECT_GT(unknown, 0);
  EXPECT_LT(unknown, 512 * 512);
  EXPECT_GE(count_not_rendered(image), unknown);
  EXPECT_EQ(metadata(image, "pixelsNotRendered"), std::to_string(unknown));
  EXPECT_EQ(metadata(image, "replicates"), "0-0");
  EXPECT_EQ(json("s.partial.json").at("samples"), (512 * 512 - unknown) * 20000);
  EXPECT_EQ(json("s.partial.json").at("camera_rays"), json("s.partial.json").at("samples"));
}

TEST_F(CommandLine, ASecondSignalEndsTheFirstPass) {
  // The first pass takes some seconds.
  Program program({"render", "scene.xml", "-o", "a.exr", "--spp", "12000", "--replicates", "2", "--threads",
                   "1", "--isa", "scalar", "--integrator", "light"},
                  folder_.path());
  program.wait_until([&] { return program.err_so_far().find("render: ") != std::string::npos; });
  program.send(SIGINT);
  program.wait_until([&] {  // On a slow machine the rest of the pass may not be worth waiting for.
    const std::string said = program.err_so_far();
    return said.find("one more signal") != std::string::npos || said.find("saved") != std::string::npos;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("to a.partial.exr"));
}

TEST_F(CommandLine, SignalsAtAnyTimeLeaveAWholeImageAndTheFinishedOne) {
  write_file(path("scene.xml"), scene_xml(16, 12));
  std::mt19937_64 engine(17);
  const int signals[]{SIGINT, SIGTERM, SIGHUP};
  std::filesystem::create_directory(path("out"));
  for (int k = 0; k < 24; ++k) {
    const bool has_finished_one = k % 2 == 1;
    const std::string finished = "finished " + std::to_string(k);
    if (has_finished_one) write_file(path("out/a.exr"), finished);
    Program program({"render", "scene.xml", "-o", "out/a.exr", "--spp", "400000", "--replicates", "400",
                     "--threads", "1", "--sampler", "sobol", "--integrator", "light"},
                    folder_.path());
    program.wait_until([&] { return program.err_so_far().find("samples a pixel") != std::string::npos; });
    std::this_thread::sleep_for(std::chrono::milliseconds(engine() % 100));
    program.send(signals[k % 3]);
    const ProgramResult result = program.wait();
    ASSERT_THAT(result.exit_code, testing::AnyOf(0, 3)) << k << result.err;
    const bool is_partial = result.exit_code == 3 && has_finished_one;
    EXPECT_EQ(count_not_rendered(read_exr(path(is_partial ? "out/a.partial.exr" : "out/a.exr"))), 0) << k;
    if (is_partial) {
      EXPECT_EQ(read_file(path("out/a.exr")), finished);
    }
    std::filesystem::remove(path("out/a.exr"));
    std::filesystem::remove(path("out/a.partial.exr"));
    EXPECT_TRUE(std::filesystem::is_empty(path("out"))) << k;
  }
}

TEST_F(CommandLine, TheImageIsSavedThoughNobodyReadsWhatIsSaid) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  Program program(long_render, folder_.path(), ends[1]);
  close(ends[1]);
  std::string said;
  for (char c; said.find("render: ") == std::string::npos && read(ends[0], &c, 1) == 1;) said += c;
  close(ends[0]);
  // More is said meanwhile.
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().exit_code, 3);
  EXPECT_EQ(count_not_rendered(read_exr(path("a.exr"))), 0);
  EXPECT_EQ(json("s.json").at("interrupted"), true);
}

/// The first pass takes minutes.
const std::vector<std::string> long_first_pass{
    "render", "scene.xml", "-o", "a.exr", "--spp",  "4000000",      "--replicates",
    "2",      "--threads", "1",  "--isa", "scalar", "--integrator", "light"};

TEST_F(CommandLine, ASignalSoonAfterOneThatWasPassedOverIsObeyed) {
  write_file(path("scene.xml"), scene_xml(256, 256));
  // A pass of some seconds, that the first signal waits for.
  std::vector<std::string> command = long_first_pass;
  command[5] = "150";
  for (int attempt = 0; attempt < 10; ++attempt) {
    Program program(command, folder_.path());
    program.wait_until([&] { return program.err_so_far().find("samples a pixel in") != std::string::npos; });
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const double first = program.seconds();
    program.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(130));
    program.send(SIGINT);
    const bool is_passed_over = program.seconds() - first < 0.17;
    std::this_thread::sleep_for(std::chrono::milliseconds(130));
    if (!is_passed_over) continue;  // The machine is busy.
    program.send(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr("a.partial.exr"));
    return;
  }
}

TEST_F(CommandLine, AFragmentWithoutPixelsIsNotSaved) {
  write_file(path("scene.xml"), scene_xml(1, 1));
  std::vector<std::string> command = long_first_pass;
  command[5] = "2000000000";
  command.push_back("--quiet");
  Program program(command, folder_.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  program.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "no pixel was rendered; no image is saved\n");
  EXPECT_THAT(files(), testing::UnorderedElementsAre("scene.xml"));
}

TEST_F(CommandLine, QuietTellsWhereADivertedImageWent) {
  write_file(path("a.exr"), "finished");
  std::vector<std::string> command = long_render;
  command.push_back("--quiet");
  Program program(command, folder_.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("to a.partial.exr"), HasSubstr("to s.partial.json"),
                                HasSubstr("a.exr is kept as it was")));
}

TEST_F(CommandLine, APartialImageBesideAFinishedOneIsPointedOutAndKept) {
  write_file(path("a.partial.exr"), "earlier");
  const ProgramResult result = run({"render", "scene.xml", "-o", "a.exr", "--spp", "4"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("a.partial.exr is of an earlier render that was interrupted"));
  EXPECT_EQ(read_file(path("a.partial.exr")), "earlier");
}

TEST_F(CommandLine, AWholeImageOfOneReplicateSaysThatItsErrorIsUnknown) {
  // A pass takes some seconds; the second one is given up at once.
  Program program({"render", "scene.xml", "-o", "a.exr", "--spp", "12000", "--replicates", "2", "--threads",
                   "1", "--isa", "scalar", "--integrator", "light"},
                  folder_.path());
  program.wait_until([&] {
    const std::string said = program.err_so_far();
    const std::size_t at = said.rfind("render: ");
    return at != std::string::npos && std::stoi(said.substr(at + 8)) > 50;
  });
  program.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("saved the whole image (1 of 2 replicates"),
                                HasSubstr("its error is unknown: it takes two replicates to tell")));
}

TEST_F(CommandLine, APartialNameThatCannotBeWrittenIsFoundBeforehand) {
  std::filesystem::create_directory(path("a.partial.exr"));
  std::filesystem::create_directory(path("s.partial.json"));
  EXPECT_THAT(run({"render", "scene.xml", "-o", "a.exr", "--spp", "1"}).err,
              HasSubstr("a.partial.exr: is a folder"));
  EXPECT_THAT(run({"render", "scene.xml", "-o", "b.exr", "--stats", "s.json", "--spp", "1"}).err,
              HasSubstr("s.partial.json: is a folder"));
}

TEST_F(CommandLine, AdviceIsPossible) {
  const ProgramResult result =
      run({"render", "scene.xml", "-o", "a.exr", "--spp", "2147483647", "--replicates", "2147483646"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("cannot be split into"), Not(HasSubstr("or take"))));
}

TEST_F(CommandLine, AnOutputThatFailsDoesNotTakeTheOthersWithIt) {
  std::filesystem::create_directory(path("gone"));
  Program program({"render", "scene.xml", "-o", "gone/a.exr", "-o", "b.exr", "-o", "gone/c.png", "--stats",
                   "s.json", "--spp", "4000", "--threads", "1", "--isa", "scalar"},
                  folder_.path());
  program.wait_until([&] { return program.err_so_far().find("samples a pixel") != std::string::npos; });
  std::filesystem::remove(path("gone"));
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("error: gone/a.exr: "), HasSubstr("error: gone/c.png: ")));
  EXPECT_EQ(read_exr(path("b.exr")).width, 40);
  EXPECT_EQ(json("s.json").at("interrupted"), false);
}

TEST_F(CommandLine, PartialNamesAreNotWrittenOverEither) {
  ASSERT_EQ(run({"render", "scene.xml", "-o", "sky.partial.exr", "--spp", "1"}).exit_code, 0);
  write_file(
      path("lit.xml"),
      "<scene><camera type=\"perspective\"/><shape type=\"rectangle\"/><emitter type=\"envmap\"><string "
      "name=\"filename\" value=\"sky.partial.exr\"/></emitter></scene>");
  EXPECT_THAT(run({"render", "lit.xml", "-o", "sky.exr", "--spp", "1"}).err,
              HasSubstr("sky.partial.exr: this file would be overwritten"));
  EXPECT_THAT(run({"render", "scene.xml", "-o", "a.exr", "-o", "a.partial.exr", "--spp", "1"}).err,
              HasSubstr("this file would be written twice"));
}

TEST_F(CommandLine, AnIntegratorOnTheCommandLineRescuesAScene) {
  const std::string scene = scene_xml(8, 6);
  const auto with = [&](const std::string& integrator) {
    write_file(path("scene.xml"), "<scene>" + integrator + scene.substr(7));
  };
  const std::vector<std::string> render_mis{"render", "scene.xml", "-o",           "a.exr",
                                            "--spp",  "2",         "--integrator", "mis"};
  with("<integrator type=\"pssmlt\"/>");
  EXPECT_EQ(run({"render", "scene.xml", "-o", "a.exr"}).exit_code, 2);
  ProgramResult result = run(render_mis);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("warning: "), HasSubstr("unknown integrator 'pssmlt'"),
                                HasSubstr("taken in its place: --integrator mis")));
  with("<integrator type=\"av\"><float name=\"length\" value=\"-1\"/></integrator>");
  EXPECT_EQ(run({"render", "scene.xml", "-o", "a.exr"}).exit_code, 2);
  result = run(render_mis);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, Not(HasSubstr("warning")));
  with("<integrator type=\"mis\"><string name=\"heuristic\" value=\"best\"/></integrator>");
  result = run(render_mis);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("taken in its place: --integrator mis"));
  EXPECT_THAT(run({"render", "scene.xml", "-o", "a.exr", "--integrator", "mist"}).err,
              HasSubstr("unknown integrator 'mist'"));
}

TEST_F(CommandLine, InterruptKeepsTheCasesThatWereRun) {
  // The second case would take minutes.
  write_file(
      path("t.xml"),
      "<test type=\"ttest\"><integer name=\"sampleCount\" value=\"2000000000\"/><string name=\"angles\" "
      "value=\"0\"/><string name=\"references\" value=\"0.5 0.5\"/>\n<bsdf type=\"mirrer\"/><bsdf "
      "type=\"phong\"/></test>");
  Program program({"test", "t.xml", "--json", "t.json", "--threads", "1"}, folder_.path());
  program.wait_until([&] { return program.out_so_far().find(" 1 ttest") != std::string::npos; });
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.out, HasSubstr("interrupted, 1 case not run"));
  ASSERT_EQ(json("t.json").size(), 1u);
  EXPECT_EQ(json("t.json")[0].at("case"), 1);
}

TEST_F(CommandLine, NothingThatIsReadIsWrittenOver) {
  const std::string scene = read_file(path("scene.xml"));
  std::filesystem::create_directory(path("sub"));
  for (const char* stats : {"scene.xml", "./scene.xml", "sub/../scene.xml"}) {
    const ProgramResult result = run({"render", "scene.xml", "-o", "a.exr", "--spp", "1", "--stats", stats});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("this file would be overwritten, and it is read"));
  }
  EXPECT_EQ(read_file(path("scene.xml")), scene);
  EXPECT_THAT(run({"render", "scene.xml", "-o", "a.exr", "--spp", "1", "--stats", "./a.exr"}).err,
              HasSubstr("this file would be written twice"));

  ASSERT_EQ(run({"render", "scene.xml", "-o", "sky.exr", "--spp", "1"}).exit_code, 0);
  write_file(
      path("lit.xml"),
      "<scene><camera type=\"perspective\"/><shape type=\"rectangle\"/><emitter type=\"envmap\"><string "
      "name=\"filename\" value=\"sky.exr\"/></emitter></scene>");
  const std::string sky = read_file(path("sky.exr"));
  std::filesystem::create_symlink("sky.exr", path("link.exr"));
  for (const char* output : {"sky.exr", "link.exr"})
    EXPECT_THAT(run({"render", "lit.xml", "-o", output, "--spp", "1"}).err,
                HasSubstr("would be overwritten"));
  EXPECT_EQ(read_file(path("sky.exr")), sky);

  write_file(path("t.xml"), "<test type=\"ttest\"/>");
  EXPECT_THAT(run({"test", "t.xml", "--json", "t.xml"}).err, HasSubstr("this file would be overwritten"));
  write_file(path("t.xml"), "<test type=\"ttest\"><string name=\"references\" value=\"1\"/>" +
                                read_file(path("lit.xml")) + "</test>");
  EXPECT_THAT(run({"test", "t.xml", "--json", "sky.exr"}).err, HasSubstr("this file would be overwritten"));
  EXPECT_EQ(read_file(path("sky.exr")), sky);
}

TEST_F(CommandLine, WholeNumbersAreTakenAsTheyStand) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"--spp", "010"}, "010 begins with a 0; write 10"},
      {{"--spp", "0x10"}, "0x10 is not a whole number"},
      {{"--replicates", "2.0"}, "2.0 is not a whole number"},
      {{"--threads", "-01"}, "-01 begins with a 0; write -1"},
      {{"--spp", "4294967297"}, "4294967297 is too large; expected at most 2147483647"},
      {{"--seed", "18446744073709551616"}, "too large; expected at most 18446744073709551615"}};
  for (const auto& [option, problem] : wrong) {
    const ProgramResult result = run({"render", "scene.xml", "-o", "a.exr", option[0], option[1]});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(problem));
  }
  EXPECT_EQ(
      run({"render", "scene.xml", "-o", "a.exr", "--spp", "1", "--seed", "18446744073709551615"}).exit_code,
      0);
}

TEST_F(CommandLine, EndingsMayBeCapitals) {
  ASSERT_EQ(run({"render", "scene.xml", "-o", "a.PNG", "-o", "a.EXR", "--spp", "1"}).exit_code, 0);
  EXPECT_EQ(read_file(path("a.PNG")).substr(1, 3), "PNG");
  EXPECT_EQ(read_exr(path("a.EXR")).width, 40);
}

TEST_F(CommandLine, AFailedRenderLeavesTheOldImage) {
  write_file(path("a.exr"), "old");
  write_file(path("bad.xml"), "<scene>");
  EXPECT_EQ(run({"render", "bad.xml", "-o", "a.exr"}).exit_code, 2);
  EXPECT_EQ(read_file(path("a.exr")), "old");
  EXPECT_THAT(files(), testing::UnorderedElementsAre("scene.xml", "bad.xml", "a.exr"));
}

TEST_F(CommandLine, AKilledRenderLeavesTheOldImage) {
  write_file(path("a.exr"), "old");
  Program program(
      {"render", "scene.xml", "-o", "a.exr", "--spp", "10000000", "--threads", "1", "--integrator", "light"},
      folder_.path());
  program.wait_until([&] { return !program.err_so_far().empty(); });
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().exit_code, -SIGKILL);
  EXPECT_EQ(read_file(path("a.exr")), "old");
}

TEST_F(CommandLine, AnOutputThatCannotBeWrittenIsNamed) {
  const ProgramResult result = run({"render", "scene.xml", "-o", "/proc/a.exr", "--spp", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("error: /proc/a.exr: "));
}

TEST_F(CommandLine, ABadSampleIsReportedWithTheCommandThatReplaysIt) {
  // Over the light's density, the radiance exceeds the largest float.
  write_file(path("scene.xml"), scene_xml(4, 4, "3e38"));
  const std::vector<std::string> sampling{
      "--integrator",    "mis",        "--light-sampler", "tree",  "--technique", "auto", "--candidates", "3",
      "--shadow-rays",   "2",          "--weights",       "power", "--spp",       "8",    "--replicates", "2",
      "--replicates-by", "scrambling", "--seed",          "7"};
  std::vector<std::string> command{"render", "scene.xml", "-o",      "a.exr",
                                   "--isa",  "scalar",    "--stats", "s.json"};
  command.insert(command.end(), sampling.begin(), sampling.end());
  const ProgramResult result = run(command);
  ASSERT_EQ(result.exit_code, 0);
  EXPECT_GT(json("s.json").at("invalid_samples"), 0);
  ASSERT_THAT(result.err, HasSubstr("samples were not finite, or were negative"));
  EXPECT_THAT(result.err, HasSubstr("the first went wrong at vertex 0: scene.xml:3:2: the rectangle 1\n"));
  const std::string start =
      "  etendue render scene.xml --integrator mis --light-sampler tree --technique auto --candidates 3 "
      "--shadow-rays 2 --weights power --spp 8 --replicates 2 --replicates-by scrambling --seed 7 --replay ";
  const std::size_t at = result.err.find(start);
  ASSERT_NE(at, std::string::npos) << result.err;
  const std::string id = result.err.substr(at + start.size(), result.err.find('\n', at) - at - start.size());
  command = {"render", "scene.xml", "--replay", id};
  command.insert(command.end(), sampling.begin(), sampling.end());
  const ProgramResult replayed = run(command);
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, AllOf(HasSubstr("camera ray"), HasSubstr("light sample      light 'lamp'"),
                                  testing::ContainsRegex("radiance            -?(inf|nan)")));
}

TEST_F(CommandLine, ReplayRefusesASampleThatTheRenderDoesNotHave) {
  for (const char* id : {"40,0,0,0", "0,30,0,0", "0,0,2,0", "0,0,0,2", "-1,0,0,0", "0,0,0", "0,0,0,0,0",
                         "a,b,c,d", ",,,", "1,2,3,"}) {
    const ProgramResult result =
        run({"render", "scene.xml", "--spp", "4", "--replicates", "2", "--replay", id});
    EXPECT_EQ(result.exit_code, 2) << id;
    EXPECT_THAT(result.err, HasSubstr("replay")) << id;
  }
}

}  // namespace
}  // namespace etendue::test

// The check of a light integrator: the right one passes, planted mistakes are named, points follow.
//
// False-alarm rate of the right one: 5e-4 by the check's own level, with fixed seeds.
#include "base/error.h"
#include "course/check.h"
#include "course/rubric.h"
#include "course/submission.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path fixtures = ETENDUE_SOURCE_DIR "/tests/course";

json read_json(const char* name) { return json::parse(test::read_file(fixtures / name)); }

/// The right solution, edited.
std::string edited(const json& edits) {
  std::string text = test::read_file(fixtures / "light_integrator.cpp");
  for (const json& edit : edits) {
    const auto old = edit[0].get<std::string>();
    const std::size_t at = text.find(old);
    if (at == std::string::npos || text.find(old, at + 1) != std::string::npos) return "";
    text.replace(at, old.size(), edit[1].get<std::string>());
  }
  return text;
}

class CourseCheck : public testing::Test {
 protected:
  IntegratorCheck check(const fs::path& module) const {
    return check_module(module,
                        {.seed = 11, .probe_seed = 12, .folder = folder.path(), .at = [](const auto&) {}});
  }
  IntegratorCheck check_of(const char* name, const char* file = "mistakes.json") const {
    for (const json& mistake : read_json(file))
      if (mistake["name"] == name) {
        test::write_file(folder.path() / "light_integrator.cpp", edited(mistake["edits"]));
        const fs::path module = folder.path() / (std::string(name) + ".so");
        const Compilation done = compile(folder.path() / "light_integrator.cpp", module, CompiledFor::speed);
        EXPECT_TRUE(done.is_done) << done.messages;
        return check(module);
      }
    throw InputError(std::string("no planted mistake ") + name);
  }
  static std::vector<std::string> names(const IntegratorCheck& check) {
    std::vector<std::string> all;
    for (const FoundMistake& found : check.diagnosis.findings) all.emplace_back(text_of(found.mistake).name);
    return all;
  }

  const test::TemporaryFolder folder;
};

TEST_F(CourseCheck, PassesTheRightOne) {
  const IntegratorCheck found = check(ETENDUE_BINARY_DIR "/tests/libcourse_light_integrator.so");
  for (const CheckedProperty& property : found.properties)
    EXPECT_EQ(property.verdict, PropertyVerdict::right) << property.name << ": " << property.what;
  EXPECT_TRUE(found.is_right());
  EXPECT_EQ(found.diagnosis.samples_wrong, 0);
  EXPECT_GT(found.diagnosis.samples_compared, 1000);
}

TEST_F(CourseCheck, PassesTheRightOneThatMissesTheSliverOfAHiddenLight) {
  const IntegratorCheck found =
      check_module(ETENDUE_BINARY_DIR "/tests/libcourse_light_integrator.so",
                   {.seed = 20040, .probe_seed = 30040, .folder = folder.path(), .at = [](const auto&) {}});
  EXPECT_TRUE(found.is_right());
}

TEST_F(CourseCheck, NamesAMistakeInOneTerm) {
  EXPECT_THAT(names(check_of("light-choice-probability-missing")),
              testing::ElementsAre("light-choice-probability-missing"));
}

TEST_F(CourseCheck, NamesAMistakeThatNoSingleSampleShows) {
  EXPECT_THAT(names(check_of("number-used-twice")), testing::ElementsAre("number-used-twice"));
}

TEST_F(CourseCheck, NamesNothingWhereALightIsSeenTooBright) {
  const IntegratorCheck found = check_of("emission twice", "unlisted.json");
  EXPECT_THAT(names(found), testing::IsEmpty());
  EXPECT_TRUE(found.diagnosis.is_unknown);
}

TEST(PlantedMistakes, EachIsAnEditOfTheRightOne) {
  for (const char* file : {"mistakes.json", "variants.json", "unlisted.json"})
    for (const json& one : read_json(file)) EXPECT_NE(edited(one["edits"]), "") << one["name"];
}

TEST(Rubric, TakesPointsForWhatIsWrong) {
  const RubricPart part{"3.2.1", 20, {{"shadows", 4}, {"mean", 3}, {"emission", 50}}};
  const auto result = [](const char* shadows, const char* emission) {
    return json{{"properties",
                 {{{"name", "shadows"}, {"verdict", shadows}},
                  {{"name", "mean"}, {"verdict", "right"}},
                  {{"name", "emission"}, {"verdict", emission}}}}};
  };
  EXPECT_EQ(points_of(part, result("right", "right")), 20);
  EXPECT_EQ(points_of(part, result("wrong", "right")), 16);
  EXPECT_EQ(points_of(part, result("cannot tell", "right")), 18);
  EXPECT_EQ(points_of(part, result("right", "wrong")), 0);
  EXPECT_EQ(points_of(part, {{"outcome", "ended"}}), 0);
}

}  // namespace
}  // namespace etendue

// `etendue course check` and `grade` on hand-ins that do not compile, end early, or are right.
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using test::ProgramResult;
using testing::ContainsRegex;
using testing::HasSubstr;
namespace fs = std::filesystem;

class CourseGrade : public testing::Test {
 protected:
  /// A hand-in whose Li is this.
  void hand_in(const std::string& name, const std::string& body) const {
    std::string text = test::read_file(ETENDUE_SOURCE_DIR "/course/ex3/light_integrator.cpp");
    const std::string marker = "Intersection its;\n    if (!scene->rayIntersect(ray_, its))";
    text.replace(text.find(marker), 0, body + "\n    ");
    text = "#include <fstream>\n" + text;
    fs::create_directory(folder.path() / name);
    test::write_file(folder.path() / name / "light_integrator.cpp", text);
  }
  ProgramResult run(const std::vector<std::string>& arguments) const {
    return test::run_program(arguments, folder.path());
  }

  const test::TemporaryFolder folder;
};

// A program built with AddressSanitizer ends by itself where it would crash.
#ifdef __SANITIZE_ADDRESS__
constexpr const char* of_crash = "the program ended before it was done";
#else
constexpr const char* of_crash = "it crashed";
#endif

TEST_F(CourseGrade, TellsWhatEndedAHandInAndGradesTheOthers) {
  hand_in("crash", "std::ofstream(\"debug.txt\") << 1; static const float* nothing = nullptr; return Color3f(nothing[1 << 20]);");
  hand_in("bad", "this is no C++;");
  const ProgramResult graded = run({"course", "grade", "crash", "bad", "not_there", "-o", "out"});
  EXPECT_EQ(graded.exit_code, 1) << graded.err;
  const std::string table = test::read_file(folder.path() / "out/grades.csv");
  EXPECT_THAT(table, HasSubstr("folder,group,outcome,3.2.1 sampleLights (20),3.2.2 Li (15)"));
  EXPECT_THAT(table, ContainsRegex("crash,0,ended,0,0,,,,,0,\"?" + std::string(of_crash)));
  EXPECT_THAT(table, HasSubstr("bad,0,does not compile,0,0,,,,,0,"));
  EXPECT_THAT(table, HasSubstr("it wrote debug.txt"));
  EXPECT_THAT(table, HasSubstr("not_there,,ended,0,0,,,,,0,there is no folder"));
  EXPECT_THAT(test::read_file(folder.path() / "out/crash/check.html"), HasSubstr(of_crash));
  EXPECT_TRUE(fs::exists(folder.path() / "out/grades.html"));
}

TEST_F(CourseGrade, RefusesABadRubric) {
  test::write_file(folder.path() / "rubric.json", "{\"title\": 3}");
  const ProgramResult refused = run({"course", "grade", "nothing", "--rubric", "rubric.json"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("a rubric is a list of"));
}

}  // namespace
}  // namespace etendue

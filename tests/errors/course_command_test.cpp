// `etendue course` on good and bad folders, and `render --plugin` on what is no plugin.
#include "support/program.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using test::Program;
using test::ProgramResult;
using ::testing::HasSubstr;

class CourseCommand : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& arguments) const {
    return Program(arguments, folder_.path()).wait(60);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }
  std::string text_of(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(CourseCommand, NewOverwritesNothing) {
  EXPECT_EQ(run({"course", "new", "ex3", "mine"}).exit_code, 0);
  EXPECT_THAT(text_of("mine/light_integrator.cpp"), HasSubstr("GROUP_NUMBER 0"));
  EXPECT_THAT(text_of("mine/scenes/ex3/area_sampling.xml"), HasSubstr("<scene>"));
  write("mine/light_integrator.cpp", "mine");
  const ProgramResult again = run({"course", "new", "ex3", "mine"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, HasSubstr("mine/light_integrator.cpp is there already, and stays"));
  EXPECT_EQ(text_of("mine/light_integrator.cpp"), "mine");
  EXPECT_THAT(run({"course", "new", "ex4", "other"}).err, HasSubstr("unknown exercise 'ex4'"));
}

TEST_F(CourseCommand, BuildSaysWhatTheCompilerSays) {
  run({"course", "new", "ex3", "mine"});
  EXPECT_EQ(run({"course", "build", "mine"}).exit_code, 0);
  const ProgramResult rendered =
      run({"render", "mine/scenes/ex3/area_sampling.xml", "--plugin", "mine/build/liblight_integrator.so",
           "--integrator", "lihgt", "-o", "x.png"});
  EXPECT_EQ(rendered.exit_code, 2);
  EXPECT_THAT(rendered.err, HasSubstr("did you mean 'light'?"));
  write("mine/light_integrator.cpp", "int main() { return x; }\n");
  const ProgramResult built = run({"course", "build", "mine"});
  EXPECT_EQ(built.exit_code, 1);
  EXPECT_THAT(built.err, HasSubstr("light_integrator.cpp:1:21: error:"));
  EXPECT_THAT(run({"course", "build", "."}).err, HasSubstr("there is no light_integrator.cpp in ."));
}

TEST_F(CourseCommand, PackTellsWhatIsLeftToDo) {
  run({"course", "new", "ex3", "mine"});
  std::string code = text_of("mine/light_integrator.cpp");
  code.replace(code.find("GROUP_NUMBER 0"), 14, "GROUP_NUMBER 7");
  write("mine/light_integrator.cpp", code);
  write("mine/readme.md", text_of("mine/readme.md") + "![a picture](nowhere.png)\n");
  const ProgramResult packed = run({"course", "pack", "mine"});
  EXPECT_EQ(packed.exit_code, 1);
  EXPECT_THAT(packed.out, HasSubstr("Exercise3_7.zip"));
  EXPECT_THAT(packed.err, HasSubstr("readme.md still says 'Group: 0'"));
  if (packed.err.find("readme.pdf was not made") == std::string::npos) {
    EXPECT_THAT(packed.err, HasSubstr("shows 'nowhere.png', which is not in"));
  }
}

TEST_F(CourseCommand, LabMakesAPageWithAllItsPictures) {
  const ProgramResult made = run({"course", "lab", "--quick", "-o", "lab.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("lab.html: 32 pictures"));
  const std::string page = text_of("lab.html"), picture = "data:image/png;base64,iVBOR";
  int pictures = 0;
  for (std::size_t at = 0; (at = page.find(picture, at)) != std::string::npos; ++at) ++pictures;
  EXPECT_EQ(pictures, 32);
  EXPECT_EQ(run({"course", "lab", "--quick", "-o", "nowhere/lab.html"}).exit_code, 2);
}

TEST_F(CourseCommand, WatchRendersWhatIsSaved) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the search for leaks needs what a sandbox does not give";
#endif
  run({"course", "new", "ex3", "mine"});
  write("scene.xml",
        "<scene><camera type=\"perspective\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" "
        "value=\"8\"/></camera><shape type=\"sphere\"/></scene>");
  const Program watch(
      {"course", "watch", "mine", "--port", "0", "--scene", "scene.xml", "--spp", "1", "--seconds", "100"},
      folder());
  const auto says = [&](const char* text) {
    return [&watch, text] { return watch.err_so_far().find(text) != std::string::npos; };
  };
  watch.wait_until(says("1 sample a pixel"));
  EXPECT_TRUE(says("1 sample a pixel")()) << watch.err_so_far();
  write("mine/light_integrator.cpp", text_of("mine/light_integrator.cpp") + "x\n");
  watch.wait_until(says("does not compile"));
  EXPECT_TRUE(says("does not compile")()) << watch.err_so_far();
  watch.send(SIGTERM);
}

TEST_F(CourseCommand, PluginsAreToldFromOtherFiles) {
  write("text.so", "no library");
  EXPECT_THAT(
      run({"render", ETENDUE_SOURCE_DIR "/scenes/first.xml", "--plugin", "text.so", "-o", "x.png"}).err,
      HasSubstr("cannot load the plugin text.so"));
}

}  // namespace
}  // namespace etendue

// Damaged and odd files of other projects' test suites: refused with a message that names them, or rendered.
#include "support/program.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

namespace etendue::test {
namespace {

std::filesystem::path data_folder() {
  const char* given = std::getenv("ETENDUE_TEST_DATA");
  return (given ? std::filesystem::path(given)
                : std::filesystem::path(ETENDUE_SOURCE_DIR) / "../shared/data") /
         "badinput";
}

std::vector<std::filesystem::path> files_of(const std::string& kind) {
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / kind, absent))
    files.push_back(std::filesystem::absolute(entry.path()));
  std::sort(files.begin(), files.end());
  return files;
}

void check(const std::vector<std::string>& arguments, const std::filesystem::path& where,
           const std::string& file) {
  const ProgramResult result = run_program(arguments, where, 20);
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2) << "exit code " << result.exit_code;
  EXPECT_LT(result.seconds, 20);
  if (result.exit_code == 2) {
    EXPECT_NE(result.err.find(file), std::string::npos);
  }
  if (testing::Test::HasFailure()) ADD_FAILURE() << result.err;
}

TEST(BadFiles, AsScenes) {
  const auto files = files_of("xml");
  if (files.empty()) GTEST_SKIP() << data_folder() << " is not there";
  const TemporaryFolder folder;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    check({"render", file.string(), "-o", "a.exr", "--spp", "1", "--threads", "1"}, folder.path(),
          file.string());
  }
}

TEST(BadFiles, AsMeshes) {
  const auto files = files_of("obj");
  if (files.empty()) GTEST_SKIP() << data_folder() << " is not there";
  const TemporaryFolder folder;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    write_file(
        folder.path() / "scene.xml",
        "<scene><camera type=\"perspective\"><integer name=\"width\" value=\"4\"/><integer name=\"height\" "
        "value=\"4\"/></camera><mesh type=\"obj\"><string name=\"filename\" value=\"" +
            file.string() + "\"/><emitter type=\"area\"/></mesh></scene>");
    check({"render", "scene.xml", "-o", "a.exr", "--spp", "1", "--threads", "1"}, folder.path(),
          file.filename().string());
  }
}

}  // namespace
}  // namespace etendue::test

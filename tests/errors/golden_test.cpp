// Each folder of cases/ holds a scene and expected.txt: a command line, and all that a person then reads.
//
// To add a case: make a folder with the files and an expected.txt of one line, "$ etendue render ...", run
// this test with ETENDUE_UPDATE_EXPECTED=1, and read what it wrote as a student would.
#include "support/program.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <sstream>

namespace etendue::test {
namespace {

const std::filesystem::path& cases_folder() {
  static const std::filesystem::path folder = ETENDUE_SOURCE_DIR "/tests/errors/cases";
  return folder;
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(cases_folder()))
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> arguments_of(const std::string& command) {
  std::istringstream stream(command);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  if (words.size() < 2 || words[0] != "$" || words[1] != "etendue")
    throw std::runtime_error("the first line of expected.txt must be: $ etendue COMMAND ...");
  return {words.begin() + 2, words.end()};
}

/// The last line of a render tells its time and speed, which differ from run to run.
std::string without_times(std::string text) {
  const std::size_t line = text.rfind("done in ");
  if (line == std::string::npos || (line > 0 && text[line - 1] != '\n')) return text;
  return text.substr(0, line) + "done in TIME\n";
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, SaysWhatIsExpected) {
  const std::filesystem::path expected_file = cases_folder() / GetParam() / "expected.txt";
  const std::string expected = read_file(expected_file);
  const std::string command = expected.substr(0, expected.find('\n'));
  const TemporaryFolder folder;
  std::filesystem::copy(cases_folder() / GetParam(), folder.path(), std::filesystem::copy_options::recursive);
  std::filesystem::remove(folder.path() / "expected.txt");

  const ProgramResult result = run_program(arguments_of(command), folder.path());
  ASSERT_NE(result.exit_code, 127) << "the program could not be started";
  const std::string said = command + "\n" + result.out + without_times(result.err) + "exit code " +
                           std::to_string(result.exit_code) + "\n";
  if (std::getenv("ETENDUE_UPDATE_EXPECTED"))
    write_file(expected_file, said);
  else
    EXPECT_EQ(said, expected);
}

INSTANTIATE_TEST_SUITE_P(Cases, Golden, testing::ValuesIn(case_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace etendue::test

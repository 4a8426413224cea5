// A program in the sandbox does no harm, and why it ended is told.
#include "course/sandbox.h"

#include "support/temporary_folder.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using ::testing::HasSubstr;

/// What a line of Python comes to.
SandboxResult run_python(const std::string& code, const SandboxLimits& limits = {.seconds = 30}) {
  return run_in_sandbox({"/usr/bin/python3", "-c", code}, limits);
}

TEST(Sandbox, KeepsWhatIsPrintedAndTheExitCode) {
  const SandboxResult result = run_python("print('hello', flush=True); raise SystemExit(3)");
  EXPECT_EQ(result.output, "hello\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(explanation(result, {}), "");
}

TEST(Sandbox, CountsWhatItDoesNotKeep) {
  const SandboxLimits limits{.seconds = 30, .output_bytes = 1000};
  const SandboxResult result = run_python("print('x' * 9999999)", limits);
  EXPECT_TRUE(result.is_done());
  EXPECT_EQ(result.output, std::string(1000, 'x'));
  EXPECT_EQ(result.printed_bytes, 10000000u);
  EXPECT_THAT(explanation(result, limits), HasSubstr("10.0 MB"));
}

TEST(Sandbox, EndsWhatDoesNotEnd) {
  // One works, one sleeps with its output closed.
  for (const char* code : {"while True: pass", "import os, time; os.close(1); os.close(2); time.sleep(60)"}) {
    const SandboxLimits limits{.seconds = 0.5};
    const SandboxResult result = run_python(code, limits);
    EXPECT_TRUE(result.is_out_of_time) << code;
    EXPECT_LT(result.seconds, 20) << code;
    EXPECT_THAT(explanation(result, limits), HasSubstr("a loop that does not end"));
  }
}

TEST(Sandbox, EndsWhenItMust) {
  const SandboxResult result = run_in_sandbox({"/usr/bin/python3", "-c", "import time; time.sleep(60)"},
                                              {.seconds = 60}, [] { return true; });
  EXPECT_TRUE(result.is_cut_short);
  EXPECT_LT(result.seconds, 20);
}

TEST(Sandbox, TellsACrash) {
  const SandboxResult result = run_python("import ctypes; ctypes.string_at(0)");
  EXPECT_EQ(result.signal, SIGSEGV);
  EXPECT_THAT(explanation(result, {}), HasSubstr("it crashed"));
}

TEST(Sandbox, LimitsMemory) {
  const SandboxLimits limits{.seconds = 30, .memory_bytes = std::size_t{1} << 30};
  const SandboxResult result = run_python("x = bytearray(2 << 30)", limits);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("MemoryError"));
}

TEST(Sandbox, EndsWhatFillsItsFolder) {
  const test::TemporaryFolder folder;
  SandboxLimits limits{.seconds = 30, .writable = {folder.path()}, .folder = folder.path()};
  limits.written_bytes = 1 << 20;
  const char* fill =
      "import time\nfor i in range(100000): open(f'{i}.txt', 'w').write('x' * 100000); time.sleep(.01)";
  for (const std::string& code :
       {std::string(fill), "import os; os.close(1); os.close(2)\n" + std::string(fill)}) {
    const SandboxResult result = run_python(code, limits);
    EXPECT_TRUE(result.is_out_of_room);
    EXPECT_THAT(explanation(result, limits), HasSubstr("it wrote files of more than"));
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "0.txt"));
}

TEST(Sandbox, LetsItWriteToOneFolderOnly) {
  const test::TemporaryFolder ours, others;
  std::ofstream(others.path() / "kept") << "text";
  const auto open_file = [](const std::filesystem::path& file) {
    return "open('" + file.string() + "', 'w').write('new')\n";
  };
  const SandboxLimits limits{.seconds = 30, .writable = {ours.path()}};
  EXPECT_TRUE(run_python(open_file(ours.path() / "made"), limits).is_done());
  EXPECT_TRUE(std::filesystem::exists(ours.path() / "made"));
  const SandboxResult result = run_python(open_file(others.path() / "made"), limits);
  if (!result.not_held.empty()) GTEST_SKIP() << result.not_held.front();
  EXPECT_THAT(result.output, HasSubstr("Permission denied"));
  EXPECT_FALSE(std::filesystem::exists(others.path() / "made"));
  EXPECT_FALSE(
      run_python("import os; os.remove('" + (others.path() / "kept").string() + "')", limits).is_done());
  EXPECT_TRUE(std::filesystem::exists(others.path() / "kept"));
}

TEST(Sandbox, KeepsItFromOtherProcessesAndMachines) {
  for (const char* code :
       {"import socket; socket.socket()", "import os; os.fork()", "import os; os.kill(os.getppid(), 0)",
        "import subprocess; subprocess.run(['/bin/true'])"})
    EXPECT_THAT(run_python(code).output, HasSubstr("not permitted")) << code;
  EXPECT_TRUE(run_python("import threading as t; a = t.Thread(target=int); a.start(); a.join()").is_done());
}

TEST(Sandbox, LetsCompilersStartPrograms) {
  EXPECT_TRUE(run_python("import subprocess; subprocess.run(['/bin/true'])",
                         {.seconds = 30, .may_start_programs = true})
                  .is_done());
}

}  // namespace
}  // namespace etendue

#include "course/submission.h"

#include "base/error.h"
#include "course/course_files.h"

#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// A program by its name, as a shell finds it; empty where there is none.
std::string program_named(const std::string& name) {
  const auto is_program = [](const fs::path& file) { return access(file.c_str(), X_OK) == 0; };
  if (name.find('/') != std::string::npos) return is_program(name) ? name : "";
  const char* path = std::getenv("PATH");
  std::string folders = path ? path : "/usr/bin:/bin";
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const fs::path file = fs::path(folders.substr(begin, end - begin)) / name;
    if (is_program(file)) return file.string();
    begin = end + 1;
  }
  return "";
}

std::string compiler() {
  const char* chosen = std::getenv("CXX");
  const std::string name = chosen && *chosen ? chosen : "c++";
  const std::string program = program_named(name);
  if (program.empty())
    throw InputError(
        fmt::format("there is no compiler '{}'\n  install one (g++ of Debian), or name it in CXX", name));
  return program;
}

}  // namespace

Submission submission_in(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(fmt::format("there is no folder {}", folder.string()));
  Submission submission{fs::canonical(folder)};
  if (!fs::is_regular_file(submission.source()))
    throw InputError(fmt::format(
        "there is no light_integrator.cpp in {}\n  etendue course new ex3 DIR starts one", folder.string()));
  return submission;
}

std::optional<int> group_number(const fs::path& source) {
  std::ifstream file(source);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    char hash = 0;
    std::string directive, name;
    int number = -1;
    if (words >> hash >> directive >> name >> number && hash == '#' && directive == "define" &&
        name == "GROUP_NUMBER" && number >= 0)
      return number;
  }
  return std::nullopt;
}

std::vector<std::string> compile_command(const fs::path& source, const fs::path& module, CompiledFor what) {
  std::vector<std::string> words{compiler(), "-std=c++20"};
  const auto add = [&](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  if (what == CompiledFor::sanitizer)
    add({"-O1", "-g", "-fno-omit-frame-pointer", "-fsanitize=address,undefined",
         "-fno-sanitize-recover=undefined"});
  else
    add({"-O2"});
  // Hidden, so that nothing of one module can be taken for another's.
  add({"-Wall", "-Wextra", "-fPIC", "-shared", "-fvisibility=hidden"});
  words.push_back("-I" + course_headers().string());
  words.push_back(source.string());
  add({"-o"});
  words.push_back(module.string());
  return words;
}

Compilation compile(const fs::path& source, const fs::path& module, CompiledFor what) {
  std::error_code failed;
  fs::create_directories(module.parent_path(), failed);
  if (failed)
    throw InputError(fmt::format("cannot make {}: {}", module.parent_path().string(), failed.message()));
  const fs::path unfinished = module.string() + ".unfinished";
  std::vector<std::string> words{"/usr/bin/env", "TMPDIR=" + module.parent_path().string()};
  const std::vector<std::string> command = compile_command(source, unfinished, what);
  words.insert(words.end(), command.begin(), command.end());
  const SandboxLimits limits{.seconds = 120, .writable = {module.parent_path()}, .may_start_programs = true};
  const SandboxResult result = run_in_sandbox(words, limits);
  if (result.is_done()) {
    fs::rename(unfinished, module);
    return {true, result.output, result.seconds};
  }
  fs::remove(unfinished, failed);
  const std::string why = explanation(result, limits);
  return {false, why.empty() ? result.output : result.output + "the compiler: " + why + "\n", result.seconds};
}

std::vector<std::string> sanitizer_environment() {
  const SandboxResult asked = run_in_sandbox({compiler(), "-print-file-name=libasan.so"}, {.seconds = 10});
  std::string library = asked.output.substr(0, asked.output.find('\n'));
  if (!asked.is_done() || library.find('/') == std::string::npos)
    throw InputError(
        "the compiler has no AddressSanitizer (libasan.so)\n  leave --sanitize out, or take g++");
  // Leaks of the program are not the student's.
  return {"/usr/bin/env", "LD_PRELOAD=" + library, "ASAN_OPTIONS=detect_leaks=0:color=never"};
}

}  // namespace etendue

// A student's folder: where its parts are, and how its code is compiled.
#pragma once

#include "course/sandbox.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct Submission {
  std::filesystem::path folder;

  std::filesystem::path source() const { return folder / "light_integrator.cpp"; }
  std::filesystem::path text() const { return folder / "readme.md"; }
  std::filesystem::path build_folder() const { return folder / "build"; }
  std::filesystem::path module() const { return build_folder() / "liblight_integrator.so"; }
};

/// Throws InputError where there is no folder, or no light_integrator.cpp in it.
Submission submission_in(const std::filesystem::path& folder);

/// The GROUP_NUMBER that a source states; none where it states none.
std::optional<int> group_number(const std::filesystem::path& source);

/// `sanitized`: reads and writes out of bounds end the program with a message; several times slower.
enum class CompiledFor { speed, sanitizer };

/// The compiler ($CXX, else c++) and its arguments. Throws InputError where there is no compiler.
std::vector<std::string> compile_command(const std::filesystem::path& source,
                                         const std::filesystem::path& module, CompiledFor what);

struct Compilation {
  bool is_done;
  std::string messages;  ///< The compiler's, as they are; or why it was ended.
  double seconds;
};
/// Compiles within limits; the module is replaced when it is complete. Makes the folder that it lies in.
Compilation compile(const std::filesystem::path& source, const std::filesystem::path& module,
                    CompiledFor what);

/// Words to put before a program that is to load a sanitized module.
std::vector<std::string> sanitizer_environment();

}  // namespace etendue

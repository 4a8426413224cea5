// What a student hands in, of what is in the folder.
#pragma once

#include "course/submission.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

struct HandIn {
  std::filesystem::path archive;        ///< Exercise3_#id.zip, in the folder.
  std::filesystem::path pdf;            ///< readme.pdf; empty where nothing could make it.
  std::vector<std::string> problems{};  ///< What is still to be done, for the student.
};

/// Makes readme.pdf of readme.md, and the archive of it and of light_integrator.cpp. What stands under these
/// names is replaced. Throws InputError where a part is missing, or the archive cannot be made.
HandIn pack(const Submission& submission);

}  // namespace etendue

// The check of a student's folder: compiled and looked at within limits, whatever it does.
#pragma once

#include "course/submission.h"

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace etendue {

struct SubmissionCheckSettings {
  std::filesystem::path program;  ///< Which `course probe` is asked of: this one.
  std::filesystem::path work;     ///< A folder for the module and for what the check leaves; is made.
  std::uint64_t seed = 1, probe_seed = 1;
  bool has_scenes = true;  ///< Looks at the exercise's two scenes too.
  double seconds = 300;    ///< That the student's code has.
};

/// What to_json of an IntegratorCheck says, and: `outcome` ("right", "wrong", "does not compile",
/// "ended"), `why` (of the last two, and what else befell), `at` (what it was doing when it was ended),
/// `compiler` and `printed` (texts), `group`, `seconds`. Throws InputError where the check itself cannot run.
nlohmann::json check_submission(const Submission& submission, const SubmissionCheckSettings& settings);

}  // namespace etendue

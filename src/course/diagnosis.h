// Which mistakes explain what a student's integrator did on the probes.
#pragma once

#include "course/light_mistakes.h"
#include "course/probe_evidence.h"
#include "course/term_fit.h"

#include <string>
#include <vector>

namespace etendue {

struct FoundMistake {
  MistakeClass mistake;
  std::string how;       ///< Which way to make it; may be empty.
  std::string evidence;  ///< With numbers.
};

struct Diagnosis {
  TermFit fit;                         ///< Of single samples; of no mistake where they are right.
  std::vector<FoundMistake> findings;  ///< The surest first.
  bool is_unknown = false;             ///< Something is wrong that no finding explains.
  std::string runner_up;               ///< The next best explanation of the single samples; may be empty.
  double share_explained = 0, share_runner_up = 0;  ///< Of the samples that are wrong.
  std::int64_t samples_compared = 0, samples_wrong = 0;
};

/// \param is_wrong whether a test has said so: mistakes that leave the image right are then none
Diagnosis diagnose(const ProbeEvidence& evidence, bool is_wrong);

}  // namespace etendue

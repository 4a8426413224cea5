// What a check says of each property of a light integrator, by tests whose errors are stated.
#pragma once

#include "course/probe_evidence.h"

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class PropertyVerdict { right, wrong, cannot_tell };
std::string_view verdict_name(PropertyVerdict verdict);  ///< "right", "wrong", "cannot tell".

struct CheckedProperty {
  std::string name;  ///< "light shares".
  PropertyVerdict verdict = PropertyVerdict::right;
  std::string what;        ///< What was found, with numbers.
  std::int64_t tests = 0;  ///< Statistical ones; 0: the property is not statistical.
  double p_value = 1;      ///< The smallest of them.
};

/// A correct integrator fails one of the statistical tests of its probes with this probability at most, and
/// one of those of its two scenes with as much: 1e-3 together.
inline constexpr double level_of_probes = 5e-4, level_of_scenes = 5e-4;

/// Of all that the probes tell.
std::vector<CheckedProperty> properties_of(const ProbeEvidence& evidence);

/// Of each probe, whether a mean of its rays is wrong.
std::vector<bool> wrong_probes(const ProbeEvidence& evidence);

}  // namespace etendue

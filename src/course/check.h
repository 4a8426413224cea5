// A check of a compiled light integrator: its properties, and what explains what is wrong.
#pragma once

#include "course/check_property.h"
#include "course/diagnosis.h"
#include "course/scene_check.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace etendue {

struct CheckSettings {
  std::string integrator{};      ///< By name; empty: the module's only one.
  std::uint64_t seed = 1;        ///< Of the samples.
  std::uint64_t probe_seed = 1;  ///< Of the probes' geometry.
  std::filesystem::path folder;  ///< For files of the check; exists and may be written to.
  std::vector<std::filesystem::path> scenes{};
  std::function<void(const std::string&)> at{};  ///< Told what comes next.
};

struct IntegratorCheck {
  std::vector<Probe> probes;
  ProbeEvidence evidence;
  std::vector<CheckedProperty> properties;
  std::vector<SceneCheck> scenes;
  Diagnosis diagnosis;

  bool is_right() const;
};

/// Throws InputError with what the student's code throws.
IntegratorCheck check_module(const std::filesystem::path& module, const CheckSettings& settings);

/// All of it but the pictures: keys are described in docs/course.md.
nlohmann::json to_json(const IntegratorCheck& check);

}  // namespace etendue

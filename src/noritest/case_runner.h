// What every kind of test does for each of its cases: time it, turn errors into results, hand them on.
#pragma once

#include "noritest/noritest.h"

#include <chrono>

namespace etendue {

/// All that a kind of test needs to know of the file and of the run.
struct TestRun {
  const SceneDesc& test;
  const TestSettings& settings;
  const CaseCallback& on_case;
  std::vector<std::string>& warnings;
  std::vector<CaseResult> results{};

  /// Runs `measure(result)`, which fills in the numbers, and judges nothing that is thrown as a pass.
  template <class Measure>
  void run_case(CaseResult result, Measure&& measure) {
    if (settings.stop && *settings.stop) return;
    const auto start = std::chrono::steady_clock::now();
    try {
      measure(result);
    } catch (const InputError& error) {
      result.is_passed = false;
      result.is_error = true;
      result.problem = error.what();
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    results.push_back(result);
    if (on_case) on_case(results.back());
  }

  void warn(const std::vector<UnreadKey>& unread) {
    for (const UnreadKey& key : unread) warnings.push_back(key.message);
  }
};

extern const Plugin ttest_plugin, chi2test_plugin;
void run_ttest(TestRun& run);
void run_chi2test(TestRun& run);

}  // namespace etendue

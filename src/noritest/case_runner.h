// What every kind of test does for each of its cases: time it, turn errors into results, hand them on.
#pragma once

#include "noritest/noritest.h"

#include <chrono>

namespace etendue {

/// Thrown out of a case that is cut short; nobody but run_case catches it.
struct Stopped {};

/// For loops over samples: as often as a fraction of a second needs.
inline void throw_if_stopped(const TestSettings& settings) {
  if (settings.stop && *settings.stop) throw Stopped();
}

/// All that a kind of test needs to know of the file and of the run.
struct TestRun {
  const SceneDesc& test;
  const TestSettings& settings;
  const CaseCallback& on_case;
  std::vector<std::string>& warnings;
  TestFileResult result{};

  /// Runs `measure(result)`, which fills in the numbers, and judges nothing that is thrown as a pass.
  template <class Measure>
  void run_case(const CaseResult& planned, Measure&& measure) {
    const auto start = std::chrono::steady_clock::now();
    CaseResult measured = planned;
    try {
      throw_if_stopped(settings);
      measure(measured);
    } catch (const Stopped&) {
      ++result.left_out;
      return;
    } catch (const InputError& error) {
      measured = planned;
      measured.is_error = true;
      measured.problem = error.what();
    }
    measured.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.cases.push_back(measured);
    if (on_case) on_case(measured);
  }

  void warn(const std::vector<UnreadKey>& unread) {
    for (const UnreadKey& key : unread) warnings.push_back(key.message);
  }
};

extern const Plugin ttest_plugin, chi2test_plugin;
void run_ttest(TestRun& run);
void run_chi2test(TestRun& run);

}  // namespace etendue

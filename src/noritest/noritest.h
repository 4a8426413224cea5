// Runs the test files of the Nori family: does the renderer give the numbers that a course expects?
#pragma once

#include "render/isa.h"
#include "sampler/sampler.h"
#include "scenefile/parameters.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct TestSettings {
  std::uint64_t seed = 0;
  Isa isa = Isa::scalar;  ///< For scenes; BSDFs and lights are tested one lane wide.
  /// Sobol points make p-values cautious: means scatter less than the t-test believes, so that a correct
  /// renderer fails less often than the level says, and a wrong one no later. Independent ones make them
  /// exact. Both hold only for estimators of bounded variance: light samples where lit surfaces meet a light
  /// have none, and there correct renderers fail more often.
  SamplerKind sampler = SamplerKind::sobol;
  const std::atomic<bool>* stop = nullptr;  ///< Once it is true, cases are left out, the running one too.
};

/// What became of one case. A number that the kind of test does not have is NaN.
struct CaseResult {
  std::string kind{};     ///< "ttest" or "chi2test".
  std::string subject{};  ///< "scene", "bsdf", "phase" or "emitter".
  std::string type{};     ///< Of the scene's integrator, the BSDF, the phase function or the emitter.
  std::string detail{};   ///< "at 45 degrees", "direction 3": which of several cases of one subject.
  double mean = std::numeric_limits<double>::quiet_NaN();
  double reference = std::numeric_limits<double>::quiet_NaN();
  double statistic = std::numeric_limits<double>::quiet_NaN();
  double p_value = std::numeric_limits<double>::quiet_NaN();
  bool is_passed = false;
  bool is_reference_estimated = false;  ///< A BSDF's: files have these from Monte Carlo runs.
  /// Why the case failed where it was not the p-value alone; an error message where it could not be run.
  std::string problem{};
  bool is_error = false;  ///< The case could not be run: bad input, or a subject that cannot be tested so.
  double seconds = 0;
};

struct TestFileResult {
  std::vector<CaseResult> cases{};
  int left_out = 0;  ///< As TestSettings::stop asked.
};

/// Called after each case, in the order of the file.
using CaseCallback = std::function<void(const CaseResult&)>;

/// The kinds of tests, `ttest` and `chi2test`, with their parameters.
const std::vector<Plugin>& test_plugins();

/// Reads a file whose root is <test>. Throws InputError for any other, and for an unknown kind of test.
SceneDesc read_test_file(const std::filesystem::path& file, std::optional<Dialect> dialect = std::nullopt);

/// Runs all cases of a file by the rules of its kind and generation (docs/scene_format.md, "Tests"). The same
/// seed gives the same numbers whatever the number of threads. Throws InputError where the test itself does
/// not make sense, such as a number of references that fits nothing; what is wrong with one case is in its
/// result. Keys that nobody read and other warnings are appended to `warnings`.
TestFileResult run_test_file(const SceneDesc& test, const TestSettings& settings, const CaseCallback& on_case,
                             std::vector<std::string>& warnings);

}  // namespace etendue

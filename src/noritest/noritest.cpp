#include "noritest/noritest.h"

#include "noritest/case_runner.h"
#include "scenefile/nori_xml.h"

#include <fmt/format.h>

namespace etendue {

const std::vector<Plugin>& test_plugins() {
  static const std::vector<Plugin> plugins{ttest_plugin, chi2test_plugin};
  return plugins;
}

SceneDesc read_test_file(const std::filesystem::path& file, std::optional<Dialect> dialect) {
  SceneDesc test = read_nori_xml(file, dialect);
  if (test.root.family != "test")
    throw InputError(test.root.location, fmt::format("the root is <{}>, not <test>", test.root.family),
                     "scenes are for etendue render");
  if (test.root.type != ttest_plugin.name && test.root.type != chi2test_plugin.name)
    throw unknown_plugin(test.root, test_plugins());
  return test;
}

TestFileResult run_test_file(const SceneDesc& test, const TestSettings& settings, const CaseCallback& on_case,
                             std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), test.warnings.begin(), test.warnings.end());
  TestRun run{test, settings, on_case, warnings};
  if (test.root.type == ttest_plugin.name)
    run_ttest(run);
  else
    run_chi2test(run);
  return std::move(run.result);
}

}  // namespace etendue

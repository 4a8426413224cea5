#include "base/error.h"
#include "course/check_page.h"
#include "course/grade_table.h"
#include "course/submission_check.h"
#include "course_commands.h"
#include "messages.h"
#include "output_files.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace etendue::app {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct GradeOptions {
  std::vector<std::string> folders;
  std::string rubric_file, out = "grades";
  SubmissionCheckSettings settings;
};

/// What cannot even be looked at is a line of the table, too.
json checked(const std::string& folder, const SubmissionCheckSettings& settings) {
  const auto ended = [&](const std::exception& error) -> json {
    return {{"folder", folder}, {"outcome", "ended"}, {"why", error.what()}, {"at", ""}};
  };
  try {
    return check_submission(submission_in(folder), settings);
  } catch (const InputError& error) {
    return ended(error);
  } catch (const fs::filesystem_error& error) {
    return ended(error);
  }
}

int run(const GradeOptions& options) {
  const Rubric rubric = options.rubric_file.empty() ? default_rubric() : read_rubric(options.rubric_file);
  const fs::path out = options.out;
  fs::create_directories(out);
  std::vector<json> results;
  std::vector<std::string> reports;
  std::set<std::string> names;
  bool are_all_right = true;
  for (const std::string& folder : options.folders) {
    std::string name = fs::weakly_canonical(folder).filename().string();
    while (!names.insert(name).second) name += "_";
    SubmissionCheckSettings settings = options.settings;
    settings.program = fs::read_symlink("/proc/self/exe");
    settings.work = fs::absolute(out) / name;
    const json& result = results.emplace_back(checked(folder, settings));
    reports.push_back(name + "/check.html");
    fs::create_directories(settings.work);
    write_text_file((settings.work / "check.html").string(), check_page(result, settings.work / "check"));
    are_all_right &= result["outcome"] == "right";
    fmt::print("{}: {}\n", folder, result["outcome"].get<std::string>());
    std::fflush(stdout);
  }
  write_text_file((out / "grades.csv").string(), grade_csv(rubric, results));
  write_text_file((out / "grades.html").string(), grade_page(rubric, results, reports));
  fmt::print("{}\n{}\n", (out / "grades.csv").string(), (out / "grades.html").string());
  return are_all_right ? done : check_failed;
}

}  // namespace

void add_course_grade_command(CLI::App& course, int& exit_code) {
  CLI::App* command = course.add_subcommand("grade", "Check many folders, each by itself, into a table");
  const auto options = std::make_shared<GradeOptions>();
  command->add_option("DIR", options->folders, "Folders that were handed in")->required();
  command->add_option("--rubric", options->rubric_file, "JSON file with points [those of the handout]");
  command->add_option("-o,--out", options->out, "Folder for the table and the reports [grades]");
  command->add_option("--seed", options->settings.seed, "Of the samples [1]");
  command->add_option("--seconds", options->settings.seconds, "Each hand-in is ended after so many [300]")
      ->check(CLI::PositiveNumber);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

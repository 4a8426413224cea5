#include "course/check_page.h"
#include "course/submission_check.h"
#include "course_commands.h"
#include "messages.h"
#include "output_files.h"
#include "run_options.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace etendue::app {

namespace {

using nlohmann::json;

struct CheckOptions {
  std::string folder, json_file, page_file;
  SubmissionCheckSettings settings;
  bool has_no_scenes = false;
};

std::string text(const json& value) { return value.get<std::string>(); }

void print_properties(const json& properties) {
  for (const json& one : properties)
    fmt::print("{:>11}  {:<22} {}\n", text(one["verdict"]), text(one["name"]), text(one["what"]));
}

/// The probes that are right, or those that are not, in words.
std::string probes_in_words(const json& probes, bool are_right) {
  std::string words;
  for (const json& probe : probes)
    if (probe["is_right"] == are_right)
      words += fmt::format("{}{} ({})", words.empty() ? "" : "; ", text(probe["name"]), text(probe["what"]));
  return words.empty() ? "none" : words;
}

void print_diagnosis(const json& result) {
  const json& diagnosis = result["diagnosis"];
  for (const json& one : diagnosis["findings"]) {
    const std::string how = text(one["how"]);
    fmt::print("\n{}{}\n  {}\n  read {}\n", text(one["what"]), how.empty() ? "" : " (" + how + ")",
               text(one["evidence"]), text(one["read"]));
  }
  if (diagnosis["is_unknown"] == true)
    fmt::print(
        "\n{}: no mistake that is known here explains it\n  wrong: {}\n  right: {}\n  the report shows it "
        "sample by sample\n",
        diagnosis["findings"].empty() ? "something is wrong" : "something else is wrong, too",
        probes_in_words(result["probes"], false), probes_in_words(result["probes"], true));
  if (const std::string runner_up = text(diagnosis["runner_up"]); !runner_up.empty())
    fmt::print(
        "\nthe next best explanation: {}\n  it explains {:.1f} % of the wrong samples, against {:.1f} %\n",
        runner_up, 100 * diagnosis["share_runner_up"].get<double>(),
        100 * diagnosis["share_explained"].get<double>());
}

int run(const CheckOptions& options) {
  const Submission submission = submission_in(options.folder);
  SubmissionCheckSettings settings = options.settings;
  settings.program = std::filesystem::read_symlink("/proc/self/exe");
  settings.work = submission.build_folder();
  settings.has_scenes = !options.has_no_scenes;
  const json result = check_submission(submission, settings);
  const std::string outcome = text(result["outcome"]), why = text(result["why"]);
  if (!text(result["compiler"]).empty()) say("{}", text(result["compiler"]));
  if (outcome == "ended") say("{}", text(result["printed"]));
  if (result.contains("properties")) {
    print_properties(result["properties"]);
    if (outcome == "wrong") print_diagnosis(result);
  }
  if (outcome == "ended" && !text(result["at"]).empty())
    fmt::print("\nended while it was at: {}\n", text(result["at"]));
  if (!why.empty()) fmt::print("\n{}: {}\n", outcome, why);
  const std::string page =
      options.page_file.empty() ? (submission.build_folder() / "check.html").string() : options.page_file;
  write_text_file(page, check_page(result, settings.work / "check"));
  if (!options.json_file.empty())
    write_text_file(options.json_file, result.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  fmt::print("\n{}, after {:.0f} s: {}\n", outcome, result["seconds"].get<double>(), page);
  return outcome == "right" ? done : check_failed;
}

}  // namespace

void add_course_check_command(CLI::App& course, int& exit_code) {
  CLI::App* command =
      course.add_subcommand("check", "Say whether light_integrator.cpp is right, and what is wrong with it");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("DIR", options->folder, "Folder of etendue course new")->required();
  command->add_option("--json", options->json_file, "JSON file with all that was found");
  command->add_option("--page", options->page_file, "Report, one HTML file [DIR/build/check.html]");
  command->add_option("--seed", options->settings.seed, "Of the samples [1]");
  command->add_option("--probe-seed", options->settings.probe_seed,
                      "Of the geometry of the small scenes that it is looked at with [1]");
  command->add_flag("--no-scenes", options->has_no_scenes, "Leave the two scenes of the exercise out");
  command->add_option("--seconds", options->settings.seconds, "The code is ended after so many [300]")
      ->check(CLI::PositiveNumber);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

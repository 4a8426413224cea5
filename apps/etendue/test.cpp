#include "base/error.h"
#include "base/temporary_file.h"
#include "commands.h"
#include "interrupt.h"
#include "messages.h"
#include "noritest/noritest.h"
#include "output_files.h"
#include "render/thread_limit.h"
#include "run_options.h"
#include "scenefile/dialect.h"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace etendue::app {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> files;
  std::string json_file, sampler = "sobol";
  RunOptions run;
  bool is_quiet = false;
};

struct Counts {
  int cases = 0, failed = 0, errors = 0, unreadable_files = 0;
  int left_out = 0, files_left_out = 0;  ///< By a signal.
};

std::string number_text(double value, int digits = 6) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}g}", value, digits);
}

void print_case(const std::string& file, int number, const CaseResult& result) {
  const std::string subject = result.detail.empty()
                                  ? fmt::format("{} {}", result.subject, result.type)
                                  : fmt::format("{} {} {}", result.subject, result.type, result.detail);
  if (result.is_error) {
    fmt::print("{} {} {} {}: not run, ERROR\n", file, number, result.kind, subject);
    std::fflush(stdout);
    say("error: {}\n", result.problem);
    return;
  }
  const std::string numbers =
      result.kind == "ttest"
          ? fmt::format("mean {} reference {}{}", number_text(result.mean), number_text(result.reference),
                        result.is_reference_estimated ? " (perhaps itself Monte Carlo)" : "")
          : fmt::format("chi-squared {}", number_text(result.statistic));
  fmt::print("{} {} {} {}: {}, p {}, {}, {:.2f} s\n", file, number, result.kind, subject, numbers,
             number_text(result.p_value, 3), result.is_passed ? "ok" : "FAILED", result.seconds);
  if (!result.problem.empty()) fmt::print("  {}\n", result.problem);
  std::fflush(stdout);
}

/// What is NaN is null.
Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const std::string& file, int number, const CaseResult& result) {
  Json json;
  json["file"] = file;
  json["case"] = number;
  json["integrator"] = result.type;
  json["kind"] = result.kind;
  json["subject"] = result.subject;
  json["detail"] = result.detail;
  json["mean"] = json_number(result.mean);
  json["reference"] = json_number(result.reference);
  json["is_reference_estimated"] = result.is_reference_estimated;
  json["statistic"] = json_number(result.statistic);
  json["p_value"] = json_number(result.p_value);
  json["passed"] = result.is_passed;
  json["problem"] = result.problem;
  json["is_error"] = result.is_error;
  json["seconds"] = result.seconds;
  return json;
}

void run_file(const Options& options, const TestSettings& settings, const std::string& file, Counts& counts,
              Json& all) {
  const SceneDesc test = read_test_file(file, options.run.dialect());
  if (!options.is_quiet) fmt::print("{}: {} ({})\n", file, dialect_name(test.dialect), test.dialect_reason);
  int number = 0;
  std::size_t warned = 0;
  std::vector<std::string> warnings;
  const auto warn = [&] {
    std::fflush(stdout);
    for (; warned < warnings.size(); ++warned)
      if (!options.is_quiet) say("warning: {}\n", warnings[warned]);
  };
  const TestFileResult result = run_test_file(
      test, settings,
      [&](const CaseResult& result) {
        warn();
        ++counts.cases;
        counts.errors += result.is_error;
        counts.failed += !result.is_passed && !result.is_error;
        ++number;
        if (!options.is_quiet || !result.is_passed) print_case(file, number, result);
        all.push_back(to_json(file, number, result));
      },
      warnings);
  counts.left_out += result.left_out;
  warn();
}

/// A file that cannot be read is reported when its turn comes.
std::vector<std::filesystem::path> files_read(const Options& options) {
  std::vector<std::filesystem::path> all;
  for (const std::string& file : options.files) {
    all.emplace_back(file);
    try {
      for (std::filesystem::path& part : files_of(read_test_file(file, options.run.dialect()), file))
        all.push_back(std::move(part));
    } catch (const InputError&) {
    }
  }
  return all;
}

void print_summary(const Options& options, const Counts& counts) {
  std::string text =
      fmt::format("{} of {} cases in {} file{} passed", counts.cases - counts.failed - counts.errors,
                  counts.cases, options.files.size(), options.files.size() == 1 ? "" : "s");
  if (counts.failed > 0) text += fmt::format(", {} FAILED", counts.failed);
  if (counts.errors > 0) text += fmt::format(", {} could not be run", counts.errors);
  if (counts.unreadable_files > 0)
    text += fmt::format("; {} file{} could not be used", counts.unreadable_files,
                        counts.unreadable_files == 1 ? "" : "s");
  if (counts.left_out > 0)
    text += fmt::format("; interrupted, {} case{} not run", counts.left_out, counts.left_out == 1 ? "" : "s");
  if (counts.files_left_out > 0)
    text += fmt::format("; interrupted, {} file{} not run", counts.files_left_out,
                        counts.files_left_out == 1 ? "" : "s");
  fmt::print("{}\n", text);
}

int run(const Options& options) {
  options.run.dialect();  // An unknown one is an error once, not for each file.
  if (!options.json_file.empty()) {
    check_destination(options.json_file);
    check_overwrites_nothing({options.json_file}, files_read(options));
  }
  const TestSettings settings{options.run.seed, options.run.isa(), sampler_from_name(options.sampler),
                              &stop_request.soon};
  const ThreadLimit thread_limit(options.run.threads);
  Counts counts;
  Json all = Json::array();
  catch_signals(LaterSignals::kill);
  for (const std::string& file : options.files) {
    if (stop_request.soon) {
      ++counts.files_left_out;
      continue;
    }
    try {
      run_file(options, settings, file, counts, all);
    } catch (const InputError& error) {  // The other files are tested all the same.
      ++counts.unreadable_files;
      std::fflush(stdout);
      say("error: {}\n", error.what());
    }
  }
  if (!options.json_file.empty()) write_text_file(options.json_file, all.dump(2) + "\n");
  print_summary(options, counts);
  if (counts.left_out > 0 || counts.files_left_out > 0) return interrupted;
  if (counts.unreadable_files > 0 || counts.errors > 0) return bad_input;
  return counts.failed > 0 ? check_failed : done;
}

}  // namespace

void add_test_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("test", "Run test files of the Nori family (ttest, chi2test): a line for each case");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->files, "Test files")->required();
  command->add_option("--json", options->json_file, "JSON file with an entry for each case")
      ->allow_extra_args(false);
  add_run_options(*command, options->run);
  command
      ->add_option(
          "--sampler", options->sampler,
          "sobol: fewer correct files fail than their level says; independent: as many. Neither holds "
          "where the variance has no bound, as for path_ems or light where lit surfaces meet a "
          "light: there more fail")
      ->capture_default_str();
  command->add_flag("--quiet", options->is_quiet, "Print only cases that fail, and the summary");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

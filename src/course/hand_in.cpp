#include "course/hand_in.h"

#include "base/error.h"
#include "course/course_files.h"

#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <string_view>

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// A program that may write to the folder only.
SandboxResult run_tool(const Submission& submission, const std::vector<std::string>& program) {
  std::vector<std::string> words{"/usr/bin/env", "TMPDIR=" + submission.build_folder().string()};
  words.insert(words.end(), program.begin(), program.end());
  return run_in_sandbox(words, {.seconds = 120,
                                .output_bytes = std::size_t{16} << 20,
                                .writable = {submission.folder},
                                .may_start_programs = true});
}

constexpr std::string_view page_head =
    "<!doctype html><meta charset=\"utf-8\"><style>@page { size: A4; margin: 2cm }"
    "body { font: 11pt/1.45 serif } img { max-width: 100% } pre { white-space: pre-wrap }"
    "table { border-collapse: collapse } td, th { border: 1px solid; padding: 2px 8px }</style>\n";

/// readme.md as a page. Throws InputError where Python's Markdown is missing.
std::string page_of(const Submission& submission) {
  const SandboxResult converted = run_tool(submission, {"/usr/bin/python3", "-m", "markdown", "-x", "tables",
                                                        "-x", "fenced_code", submission.text().string()});
  if (!converted.is_done())
    throw InputError(
        "readme.pdf was not made: it needs Markdown of Python\n"
        "  scripts/setup.sh course installs it (python3-markdown of Debian), or make the PDF of "
        "readme.md by any other means");
  return std::string(page_head) + converted.output;
}

/// Pictures of a page that are not in the folder.
std::vector<std::string> missing_pictures(const std::string& page, const fs::path& folder) {
  constexpr std::string_view tag = "<img", source = " src=\"";
  std::vector<std::string> missing;
  for (std::size_t at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) {
    const std::size_t begin = page.find(source, at);
    if (begin == std::string::npos) break;
    const std::size_t first = begin + source.size();
    const std::string name = page.substr(first, page.find('"', first) - first);
    if (name.find(':') == std::string::npos && !fs::exists(folder / name)) missing.push_back(name);
  }
  return missing;
}

/// Throws InputError where a tool is missing, or fails. \param problems takes what is not as it should be
fs::path make_pdf(const Submission& submission, std::vector<std::string>& problems) {
  const fs::path page = submission.build_folder() / "readme.html", pdf = submission.folder / "readme.pdf";
  const std::string text = page_of(submission);
  for (const std::string& name : missing_pictures(text, submission.folder))
    problems.push_back(
        fmt::format("readme.md shows '{}', which is not in {}", name, submission.folder.string()));
  std::ofstream(page) << text;
  if (!fs::exists("/usr/bin/weasyprint"))
    throw InputError(
        fmt::format("readme.pdf was not made: it needs WeasyPrint\n"
                    "  scripts/setup.sh course installs it, or open {} in a browser and print it "
                    "to readme.pdf",
                    page.string()));
  const SandboxResult printed =
      run_tool(submission,
               {"/usr/bin/weasyprint", "-u", submission.folder.string() + "/", page.string(), pdf.string()});
  if (!printed.is_done())
    throw InputError(fmt::format("readme.pdf was not made: WeasyPrint says\n{}", printed.output));
  return pdf;
}

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

HandIn pack(const Submission& submission) {
  if (!fs::exists(submission.text()))
    throw InputError(fmt::format("there is no readme.md in {}", submission.folder.string()));
  fs::create_directories(submission.build_folder());
  HandIn result;
  const std::optional<int> group = group_number(submission.source());
  if (!group || *group == 0)
    result.problems.emplace_back("light_integrator.cpp has no group number yet: #define GROUP_NUMBER");
  if (text_of_file(submission.text()) == text_of_file(exercise_named("ex3").files / "readme.md"))
    result.problems.emplace_back("readme.md is as it came: nothing is filled in");
  else if (group.value_or(0) != 0 && text_of_file(submission.text()).find("\nGroup: 0 ") != std::string::npos)
    result.problems.emplace_back(
        fmt::format("readme.md still says 'Group: 0', and light_integrator.cpp has group {}", *group));
  try {
    result.pdf = make_pdf(submission, result.problems);
  } catch (const InputError& error) {
    result.problems.emplace_back(error.what());
    // One that the student made by other means.
    if (const fs::path own = submission.folder / "readme.pdf"; fs::exists(own)) result.pdf = own;
  }
  result.archive = submission.folder / fmt::format("Exercise3_{}.zip", group.value_or(0));
  const fs::path unfinished = submission.build_folder() / "unfinished.zip";
  std::vector<std::string> words{"/usr/bin/python3",          "-m", "zipfile", "-c", unfinished.string(),
                                 submission.source().string()};
  if (!result.pdf.empty()) words.push_back(result.pdf.string());
  const SandboxResult zipped = run_tool(submission, words);
  if (!zipped.is_done())
    throw InputError(fmt::format("{} was not made:\n{}", result.archive.string(), zipped.output));
  fs::rename(unfinished, result.archive);
  return result;
}

}  // namespace etendue

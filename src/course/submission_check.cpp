#include "course/submission_check.h"

#include "base/error.h"
#include "course/course_files.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>

namespace etendue {

namespace fs = std::filesystem;

namespace {

std::string text_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What the process left; null where it did not come so far. The file is whole or not there, but the
/// student's code could write it, too.
nlohmann::json left_in(const fs::path& folder) {
  const nlohmann::json left = nlohmann::json::parse(text_in(folder / "check.json"), nullptr, false);
  return left.is_object() && left.contains("is_right") && left.contains("properties") ? left
                                                                                      : nlohmann::json();
}

/// What the student's code wrote, for the reader; empty where it wrote nothing.
std::string written_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& file : fs::directory_iterator(folder))
    names.push_back(file.path().filename().string());
  if (names.empty()) return "";
  std::sort(names.begin(), names.end());
  constexpr std::size_t most = 3;
  const std::size_t shown = std::min(names.size(), most);
  return fmt::format("it wrote {}{}, which no integrator has to",
                     fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                     names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "");
}

}  // namespace

nlohmann::json check_submission(const Submission& submission, const SubmissionCheckSettings& settings) {
  fs::create_directories(settings.work);
  const fs::path work = fs::canonical(settings.work);  // The student's code runs in another folder.
  const fs::path module = work / "light_integrator.so", folder = work / "check",
                 of_student = work / "written";
  nlohmann::json result{{"folder", submission.folder.string()}, {"seconds", 0.0}, {"why", ""}};
  if (const std::optional<int> group = group_number(submission.source())) result["group"] = *group;
  const Compilation compilation = compile(submission.source(), module, CompiledFor::speed);
  result["compiler"] = compilation.messages;
  if (!compilation.is_done) {
    result["outcome"] = "does not compile";
    result["why"] = "the compiler's messages say where";
    return result;
  }
  // What an earlier check has left is not this one's.
  for (const fs::path& one : {folder, of_student}) {
    fs::remove_all(one);
    fs::create_directories(one);
  }
  std::vector<std::string> words{settings.program,
                                 "course",
                                 "probe",
                                 module,
                                 folder,
                                 "--seed",
                                 std::to_string(settings.seed),
                                 "--probe-seed",
                                 std::to_string(settings.probe_seed)};
  if (settings.has_scenes)
    for (const char* name : {"area_sampling.xml", "phong_plates.xml"})
      words.insert(words.end(), {"--scene", exercise_named("ex3").scenes / name});
  const SandboxLimits limits{.seconds = settings.seconds,
                             .memory_bytes = memory_for_rendering(),
                             .writable = {folder, of_student},
                             .folder = of_student};
  const SandboxResult ended = run_in_sandbox(words, limits);
  result["seconds"] = compilation.seconds + ended.seconds;
  result["printed"] = ended.output;
  result["printed_bytes"] = ended.printed_bytes;
  result["at"] = text_in(folder / "at.txt");
  const nlohmann::json left = ended.is_done() ? left_in(folder) : nlohmann::json();
  std::string why = explanation(ended, limits);
  if (left.is_null() && why.empty()) why = "the program ended before it was done; what it printed says why";
  if (const std::string written = written_files(of_student); !written.empty())
    why += (why.empty() ? "" : "; ") + written;
  result["why"] = why;
  if (left.is_null()) {
    result["outcome"] = "ended";
    return result;
  }
  result.update(left);
  result["outcome"] = left["is_right"] == true ? "right" : "wrong";
  return result;
}

}  // namespace etendue

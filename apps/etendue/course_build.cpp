#include "course/submission.h"
#include "course_commands.h"
#include "messages.h"

#include <fmt/ranges.h>
#include <memory>
#include <string>

namespace etendue::app {

namespace {

struct BuildOptions {
  std::string folder;
  bool is_sanitized = false, is_command_printed = false;
};

int run(const BuildOptions& options) {
  const Submission submission = submission_in(options.folder);
  const CompiledFor what = options.is_sanitized ? CompiledFor::sanitizer : CompiledFor::speed;
  if (options.is_command_printed) {
    fmt::print("{}\n", fmt::join(compile_command(submission.source(), submission.module(), what), " "));
    return done;
  }
  const Compilation compilation = compile(submission.source(), submission.module(), what);
  say("{}", compilation.messages);
  if (!compilation.is_done) return check_failed;
  fmt::print("{}\n", submission.module().string());
  return done;
}

}  // namespace

void add_course_build_command(CLI::App& course, int& exit_code) {
  CLI::App* command =
      course.add_subcommand("build", "Compile light_integrator.cpp, for render --plugin DIR/build/...");
  const auto options = std::make_shared<BuildOptions>();
  command->add_option("DIR", options->folder, "Folder of etendue course new")->required();
  command->add_flag("--sanitize", options->is_sanitized,
                    "Find reads and writes out of bounds: several times slower");
  command->add_flag("--print-command", options->is_command_printed, "Only say how it would be compiled");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

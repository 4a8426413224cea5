#include "course/hand_in.h"
#include "course_commands.h"
#include "messages.h"

#include <memory>
#include <string>

namespace etendue::app {

namespace {

int run(const std::string& folder) {
  const HandIn made = pack(submission_in(folder));
  for (const std::string& problem : made.problems) say("warning: {}\n", problem);
  if (!made.pdf.empty()) fmt::print("{}\n", made.pdf.string());
  fmt::print("{}\n", made.archive.string());
  if (!made.problems.empty()) say("packed, but for the warnings above it is not what should be handed in\n");
  return made.problems.empty() ? done : check_failed;
}

}  // namespace

void add_course_pack_command(CLI::App& course, int& exit_code) {
  CLI::App* command = course.add_subcommand("pack", "Make readme.pdf and Exercise3_#id.zip, to hand in");
  const auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "Folder of etendue course new")->required();
  command->callback([folder, &exit_code] { exit_code = run(*folder); });
}

}  // namespace etendue::app

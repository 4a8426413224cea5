#include "course/course_files.h"
#include "course_commands.h"
#include "messages.h"

#include <memory>
#include <string>

namespace etendue::app {

namespace {

struct NewOptions {
  std::string exercise, folder;
};

int run(const NewOptions& options) {
  for (const std::filesystem::path& kept : start_exercise(options.exercise, options.folder))
    say("{} is there already, and stays\n", kept.string());
  fmt::print(
      "{0}: read README.md there, complete light_integrator.cpp\n"
      "etendue course watch {0} shows the picture whenever you save\n",
      options.folder);
  return done;
}

}  // namespace

void add_course_new_command(CLI::App& course, int& exit_code) {
  CLI::App* command = course.add_subcommand("new", "Start a folder with an exercise; nothing is overwritten");
  const auto options = std::make_shared<NewOptions>();
  command->add_option("EXERCISE", options->exercise, "Which: ex3")->required();
  command->add_option("DIR", options->folder, "Folder to put it into")->required();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

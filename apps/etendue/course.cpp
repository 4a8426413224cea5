#include "course_commands.h"

namespace etendue::app {

void add_course_command(CLI::App& app, int& exit_code) {
  CLI::App* course = app.add_subcommand("course", "Write a light integrator of your own: docs/course.md");
  course->require_subcommand(1);
  add_course_new_command(*course, exit_code);
  add_course_build_command(*course, exit_code);
  add_course_watch_command(*course, exit_code);
  add_course_check_command(*course, exit_code);
  add_course_probe_command(*course, exit_code);
  add_course_grade_command(*course, exit_code);
  add_course_pack_command(*course, exit_code);
  add_course_lab_command(*course, exit_code);
}

}  // namespace etendue::app

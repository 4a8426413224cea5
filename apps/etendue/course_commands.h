// What `etendue course` can do: each adds itself below that command and runs when chosen.
#pragma once

#include "commands.h"

namespace etendue::app {

void add_course_new_command(CLI::App& course, int& exit_code);
void add_course_build_command(CLI::App& course, int& exit_code);
void add_course_watch_command(CLI::App& course, int& exit_code);
void add_course_check_command(CLI::App& course, int& exit_code);
void add_course_probe_command(CLI::App& course, int& exit_code);
void add_course_grade_command(CLI::App& course, int& exit_code);
void add_course_pack_command(CLI::App& course, int& exit_code);
void add_course_lab_command(CLI::App& course, int& exit_code);

}  // namespace etendue::app

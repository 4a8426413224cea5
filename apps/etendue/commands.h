// The commands of the program: each adds itself to the command line and runs when chosen.
#pragma once

#include <CLI/CLI.hpp>

namespace etendue::app {

/// Exit codes, the same for all commands.
enum ExitCode { done = 0, check_failed = 1, bad_input = 2, interrupted = 3 };

/// Each sets `exit_code` when its command has run. Errors leave it as InputError.
void add_render_command(CLI::App& app, int& exit_code);
void add_verify_command(CLI::App& app, int& exit_code);
void add_lint_command(CLI::App& app, int& exit_code);
void add_test_command(CLI::App& app, int& exit_code);
void add_course_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);

}  // namespace etendue::app

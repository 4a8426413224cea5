#include "base/error.h"
#include "commands.h"
#include "messages.h"

#include <algorithm>
#include <exception>
#include <fmt/format.h>
#include <new>
#include <string>
#include <vector>

namespace {

using namespace etendue;

/// What CLI11 found no use for, with the names that may have been meant.
std::string unexpected_argument(const CLI::App& app) {
  const CLI::App* command = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  std::vector<std::string> names;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& argument : app.remaining(true))
    if (argument.size() > 1 && argument[0] == '-')
      return fmt::format("unknown option '{}'\n{}", argument, known_names(argument, names));
  return fmt::format("'{}' was not expected", app.remaining(true).front());
}

/// CLI11 would say only that a command is needed.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) == names.end())
    throw InputError({}, fmt::format("unknown command '{}'", argv[1]), known_names(argv[1], names));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Etendue renders scenes with area lights, and tells the error of every pixel."};
  app.require_subcommand(1);
  app.set_version_flag("--version", ETENDUE_VERSION);
  int exit_code = app::done;
  app::add_render_command(app, exit_code);
  app::add_verify_command(app, exit_code);
  app::add_lint_command(app, exit_code);
  app::add_test_command(app, exit_code);
  app::add_course_command(app, exit_code);
  app::add_info_command(app, exit_code);
  try {
    check_command(app, argc, argv);
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ExtrasError&) {
    app::say("error: {}\n", unexpected_argument(app));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string command =
        app.get_subcommands().empty() ? "" : " " + app.get_subcommands().front()->get_name();
    app::say("error: {}\nsee etendue{} --help\n", error.what(), command);
  } catch (const InputError& error) {
    app::say("error: {}\n", error.what());
  } catch (const std::bad_alloc&) {
    app::say("error: out of memory\n  make the scene or the image smaller\n");
  } catch (const std::exception& error) {
    app::say("error: {}\n", error.what());
  }
  return app::bad_input;
}

#include <cstdio>
#include <exception>
#include <new>

#include "base/error.h"
#include "commands.h"

int main(int argc, char** argv) {
  using namespace etendue;
  CLI::App app{"Etendue renders scenes with area lights, and tells the error of every pixel."};
  app.require_subcommand(1);
  app.set_version_flag("--version", ETENDUE_VERSION);
  int exit_code = app::done;
  app::add_render_command(app, exit_code);
  app::add_info_command(app, exit_code);
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    const bool is_help = app.exit(error) == 0;
    return is_help ? app::done : app::bad_input;
  } catch (const InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "error: out of memory\n  make the scene or the image smaller\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  }
  return app::bad_input;
}

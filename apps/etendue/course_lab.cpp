#include "base/temporary_file.h"
#include "course/course_files.h"
#include "course/lab_page.h"
#include "course_commands.h"
#include "interrupt.h"
#include "messages.h"
#include "output_files.h"
#include "progress.h"

#include <memory>
#include <string>

namespace etendue::app {

namespace {

struct LabOptions {
  std::string page_file = "lab.html";
  int threads = 0;
  bool is_quick = false;
};

int run(const LabOptions& options) {
  check_destination(options.page_file);
  catch_signals(LaterSignals::kill);
  const LabGrid grid = lab_grid(options.is_quick);
  Progress progress("lab", false);
  const std::optional<Lab> lab = render_lab(
      exercise_named("ex3").scenes / "phong_plates.xml", grid, options.threads, available_isas().back(),
      [&](double fraction) { progress.update(fraction); }, stop_request);
  if (!lab) {
    progress.say("interrupted: no page was written");
    return interrupted;
  }
  write_text_file(options.page_file, lab_page(grid, *lab));
  fmt::print("{}: {} pictures; open it in a browser\n", options.page_file, lab->pictures.size());
  return done;
}

}  // namespace

void add_course_lab_command(CLI::App& course, int& exit_code) {
  CLI::App* command = course.add_subcommand(
      "lab", "Make a page to try out 3.3: the plates by each method, with sliders for what they depend on");
  const auto options = std::make_shared<LabOptions>();
  command->add_option("-o,--output", options->page_file, "The page, one HTML file [lab.html]");
  command->add_option("--threads", options->threads, "[all cores]")->check(CLI::Range(0, 4096));
  command->add_flag("--quick", options->is_quick, "Few and small pictures, to see that it works");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

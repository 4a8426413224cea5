#include "course/check.h"
#include "course_commands.h"
#include "output_files.h"
#include "run_options.h"

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace etendue::app {

namespace {

struct ProbeOptions {
  std::string module;
  CheckSettings settings;
  std::vector<std::string> scenes;
};

/// Runs in the process that `check` has put within limits: what it was at is left there if it ends early.
int run(const ProbeOptions& options) {
  CheckSettings settings = options.settings;
  const std::filesystem::path folder = settings.folder;
  settings.scenes.assign(options.scenes.begin(), options.scenes.end());
  settings.at = [&](const std::string& what) { write_text_file(folder / "at.txt", what); };
  const IntegratorCheck check = check_module(options.module, settings);
  for (const SceneCheck& scene : check.scenes) {
    const std::string name = scene.property.name.substr(scene.property.name.find(' ') + 1);
    write_png(folder / (name + "_students.png"), scene.students);
    write_png(folder / (name + "_light.png"), scene.lights);
    write_png(folder / (name + "_difference.png"), scene.difference);
  }
  write_text_file(folder / "check.json", to_json(check).dump(1));
  return done;
}

}  // namespace

void add_course_probe_command(CLI::App& course, int& exit_code) {
  CLI::App* command = course.add_subcommand("probe", "What check does with a compiled file, without limits");
  command->group("");
  const auto options = std::make_shared<ProbeOptions>();
  command->add_option("MODULE", options->module)->required();
  command->add_option("FOLDER", options->settings.folder)->required();
  command->add_option("--seed", options->settings.seed);
  command->add_option("--probe-seed", options->settings.probe_seed);
  command->add_option("--integrator", options->settings.integrator);
  command->add_option("--scene", options->scenes);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

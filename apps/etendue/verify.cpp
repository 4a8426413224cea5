#include "verify/verify.h"

#include "base/error.h"
#include "base/temporary_file.h"
#include "commands.h"
#include "image/image_file.h"
#include "interrupt.h"
#include "lifted_lights.h"
#include "messages.h"
#include "output_files.h"
#include "progress.h"
#include "render/thread_limit.h"
#include "render_options.h"
#include "scenefile/nori_xml.h"
#include "verify_report.h"

#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace etendue::app {

namespace {

struct VerifyOptions {
  std::string scene_file, json_file, map_file, against, against_stderr;
  std::vector<std::string> integrators;
  std::optional<int> samples_per_pixel, against_samples;
  std::optional<double> seconds;
  double level = 1e-3;
  RunOptions run;
  bool is_quiet = false;
};

std::vector<std::string> files_written(const VerifyOptions& options) {
  std::vector<std::string> files;
  for (const std::string& file : {options.json_file, options.map_file})
    if (!file.empty()) files.push_back(file);
  return files;
}

VerifySettings settings_for(const VerifyOptions& options) {
  VerifySettings settings;
  settings.samples_per_pixel = options.samples_per_pixel;
  if (options.seconds) settings.seconds = *options.seconds;
  settings.level = options.level;
  settings.seed = options.run.seed;
  settings.threads = options.run.threads;
  settings.isa = options.run.isa();
  return settings;
}

int run(const VerifyOptions& options) {
  if (!options.map_file.empty()) {
    check_writable(options.map_file);
    if (image_format(options.map_file) != ImageFormat::exr)
      throw InputError(fmt::format("{}: the map has signed numbers, which only an EXR holds\nname it .exr",
                                   options.map_file));
  }
  for (const std::string& file : files_written(options)) check_destination(file);
  const SceneDesc description = read_nori_xml(options.scene_file, options.run.dialect());
  std::vector<std::filesystem::path> files_read = files_of(description, options.scene_file);
  for (const std::string& file : {options.against, options.against_stderr})
    if (!file.empty()) files_read.emplace_back(file);
  check_overwrites_nothing(files_written(options), files_read);
  const ThreadLimit thread_limit(options.run.threads);
  LoadSettings loading;
  LoadedScene loaded = load_scene(description, loading);
  const IntegratorSettings own = integrator_for({}, loaded, description.dialect, loaded.warnings);
  check_has_light(description, loaded.scene);
  VerifySettings settings = settings_for(options);
  std::optional<ForeignImage> foreign;
  if (!options.against.empty()) {
    foreign = read_foreign_image({options.against, options.against_stderr, options.against_samples},
                                 loaded.scene.camera.width_px, loaded.scene.camera.height_px);
    settings.against = &*foreign;
    settings.against_name = options.against;
  }
  lift_lights(description, lint({loaded.scene, loaded.places, own, 64}, brief), options.is_quiet, loading,
              loaded);
  if (!options.is_quiet)
    for (const std::string& warning : loaded.warnings) say("warning: {}\n", warning);
  const Estimators estimators =
      options.integrators.empty()
          ? estimators_of(loaded.scene, own)
          : estimators_named(loaded.scene, options.integrators, options.against.empty() ? 2 : 1);
  catch_signals(LaterSignals::kill);
  const VerifyResult result = [&] {
    Progress bar("verify", options.is_quiet);
    return verify(
        loaded.scene, estimators, settings, [&](double fraction) { bar.update(fraction); }, &stop_request);
  }();
  fmt::print("{}", report_text(result, loaded.scene, loaded.places));
  if (!options.json_file.empty())
    write_text_file(options.json_file, report_json(result, loaded.scene, options.scene_file).dump(2) + "\n");
  if (!options.map_file.empty()) write_map(options.map_file, result);
  if (result.is_interrupted) {
    say("interrupted: {} of {} estimators were compared\n", result.estimators.size(), estimators.all.size());
    return interrupted;
  }
  return result.verdict == Verdict::agree ? done : check_failed;
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "verify", "Render a scene by every technique that applies, and test whether the images agree");
  const auto options = std::make_shared<VerifyOptions>();
  command->add_option("SCENE", options->scene_file, "Scene file (XML of the Nori family)")->required();
  command
      ->add_option(
          "--integrators", options->integrators,
          "Which to compare, instead of all that apply to the file's: light,direct,mis; each may have "
          "options behind it: \"light --technique solid_angle,mis\"")
      ->delimiter(',')
      ->allow_extra_args(false);
  CLI::Option* spp = command
                         ->add_option("--spp", options->samples_per_pixel,
                                      "Samples a pixel of each, rounded up to a multiple of the replicates")
                         ->check(whole_number(1 << 20))
                         ->check(CLI::Range(1, 1 << 20));
  command->add_option("--time", options->seconds, "Seconds for all of them together [60]")
      ->check(positive_number())
      ->excludes(spp);
  command
      ->add_option("--level", options->level,
                   "How often a correct scene may be said to differ, over all tests of the run")
      ->capture_default_str()
      ->check(CLI::Range(1e-12, 0.5));
  command
      ->add_option("-o,--output", options->map_file,
                   "EXR of the pair that differs most: where, in standard errors, with sign")
      ->allow_extra_args(false);
  CLI::Option* against =
      command->add_option("--against", options->against, "Another renderer's image of the scene, same size")
          ->allow_extra_args(false);
  command->add_option("--against-stderr", options->against_stderr, "Image of its standard errors")
      ->allow_extra_args(false)
      ->needs(against);
  command
      ->add_option("--against-spp", options->against_samples,
                   "Samples a pixel that it was rendered with, for a layer of the variance of one sample")
      ->check(whole_number(1 << 30))
      ->needs(against);
  command->add_option("--json", options->json_file, "JSON file with all pairs")->allow_extra_args(false);
  add_run_options(*command, options->run);
  command->add_flag("--quiet", options->is_quiet, "No progress and no warnings about the file");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace etendue::app

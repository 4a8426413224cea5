#include "base/temporary_file.h"
#include "commands.h"
#include "error_report.h"
#include "image/image_file.h"
#include "interrupt.h"
#include "lifted_lights.h"
#include "messages.h"
#include "noise_report.h"
#include "output_files.h"
#include "pilots.h"
#include "plugin.h"
#include "progress.h"
#include "render/check_settings.h"
#include "render/thread_limit.h"
#include "render_outputs.h"
#include "replay.h"
#include "scenefile/nori_xml.h"
#include "scenefile/scene_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace etendue::app {

namespace {

void announce(const RenderOptions& options, const SceneDesc& description, const LoadedScene& loaded,
              const RenderSettings& settings) {
  if (options.is_quiet) return;
  if (!description.is_dialect_told)
    say("note: nothing in {} tells which generation of Nori it is for, so it is read as '{}'; where the "
        "picture comes "
        "out mirrored,\n  it is another's: pass --dialect nori-eth (or nori-2012), or let its folder say so "
        "for all "
        "scenes, in a file etendue.json:\n  {{\"dialect\": \"nori-eth\"}}\n",
        options.scene_file, dialect_name(description.dialect));
  const int threads = settings.threads > 0 ? settings.threads : available_threads();
  say("{}: {} ({}), {}x{}, {} samples a pixel in {} replicates, {}, {} threads, {}\n", options.scene_file,
      dialect_name(description.dialect), description.dialect_reason, loaded.scene.camera.width_px,
      loaded.scene.camera.height_px, settings.samples_per_pixel, settings.replicate_count(),
      settings.integrator.name, threads, isa_name(settings.isa));
}

RenderResult render_with_progress(const Scene& scene, const RenderSettings& settings, bool is_quiet) {
  Progress bar("render", is_quiet);
  bool has_said_why = false;
  return render(
      scene, settings,
      [&](const RenderProgress& progress) {
        if (progress.seconds_to_finish && !has_said_why)
          bar.say(fmt::format(
              "stopping once every pixel has enough samples, in about {}; one more signal stops at once",
              duration_text(*progress.seconds_to_finish)));
        has_said_why = has_said_why || progress.seconds_to_finish;
        bar.update(progress.fraction);
      },
      &stop_request);
}

int run(const RenderOptions& options) {
  for (const std::string& output : options.outputs) check_writable(output);
  for (const std::string& file : files_written(options)) check_destination(file);
  const SceneDesc description = read_nori_xml(options.scene_file, options.run.dialect());
  if (options.replay.empty())
    check_overwrites_nothing(files_written(options), files_of(description, options.scene_file));
  const ThreadLimit thread_limit(options.run.threads);
  LoadSettings loading{.edges = options.is_watertight ? Edges::watertight : Edges::fast};
  LoadedScene loaded = load_scene(description, loading);
  if (!options.sampler.empty()) loaded.scene.sampler = sampler_from_name(options.sampler);
  RenderSettings settings = settings_for(options, loaded);
  const auto integrator_asked_for = [&] {
    return options.plugin.empty()
               ? integrator_for(options.integrator, loaded, description.dialect, loaded.warnings)
               : integrator_of_plugin(options, loaded);
  };
  IntegratorSettings asked_for = integrator_asked_for();
  settings.integrator = settled(asked_for, loaded.scene.lights);
  if (settings.integrator.needs_lights()) check_has_light(description, loaded.scene);
  const std::vector<ImageRegion> regions =
      regions_of(options.regions, loaded.scene.camera.width_px, loaded.scene.camera.height_px);
  const RenderLayers layers = render_layers(options, loaded.scene.lights, settings);
  check_settings(settings);
  LintSubject subject{loaded.scene, loaded.places, settings.integrator, settings.samples_per_pixel};
  const std::vector<Finding> findings = lint(subject, brief);
  warn(options, loaded.warnings, options.replay.empty() ? findings : std::vector<Finding>{});
  lift_lights(description, findings, options.is_quiet, loading, loaded);
  if (!options.plugin.empty())
    asked_for = integrator_asked_for();  // it knows the tables of the scene as it is now
  settings.integrator = asked_for;
  if (compensates_environments(asked_for)) loaded.scene.lights.compensate_environments();
  catch_signals(LaterSignals::hurry);
  const Pilots pilots = settle_by_pilots(options, loaded.scene, settings);
  if (pilots.is_interrupted) {
    say("interrupted before the image was begun: no file was written\n");
    return interrupted;
  }
  if (!options.replay.empty()) {
    const SampleId sample = sample_id_from_text(options.replay);
    if (!options.outputs.empty() || !options.stats_file.empty())
      say("warning: --replay computes one sample; no file is written\n");
    fmt::print("{}", describe(loaded.scene, sample, replay(loaded.scene, settings, sample)));
    return done;
  }
  const std::uint64_t hash = scene_hash(description);
  subject.samples_per_pixel = settings.samples_per_pixel;
  announce(options, description, loaded, settings);
  RenderResult rendered = render_with_progress(loaded.scene, settings, options.is_quiet);
  ImageErrors errors = errors_of(rendered, settings, regions, options.confidence);
  const Rendering rendering{
      options, description, loaded, settings, layers, hash, std::move(rendered), std::move(errors), pilots};
  const RenderResult& result = rendering.result;
  const WrittenFiles written = write_outputs(rendering);
  report_invalid(rendering);
  report_dark(rendering, subject);
  report_errors(rendering);
  report_noise(rendering);
  say_what_was_saved(rendering, written);
  if (!options.is_quiet)
    say("{} in {}: {:.1f} million samples a second\n", result.is_interrupted ? "interrupted" : "done",
        duration_text(result.seconds), 1e-6 * double(result.counts.samples) / result.seconds);
  if (!written.are_all) return bad_input;
  return result.is_interrupted ? interrupted : done;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("render", "Render a scene to EXR and PNG images");
  const auto options = std::make_shared<RenderOptions>();
  add_render_options(*command, *options);
  command->callback([options, &exit_code] {
    if (options->outputs.empty() && options->replay.empty()) throw CLI::RequiredError("--output");
    exit_code = run(*options);
  });
}

}  // namespace etendue::app

#include "render/render.h"

#include "base/hash.h"
#include "base/temporary_file.h"
#include "commands.h"
#include "image/image_file.h"
#include "interrupt.h"
#include "output_files.h"
#include "progress.h"
#include "render/thread_limit.h"
#include "replay.h"
#include "run_options.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"

#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sys/resource.h>

namespace etendue::app {

namespace {

struct Options {
  std::string scene_file;
  std::vector<std::string> outputs;
  std::string integrator, sampler, light_sampler, stats_file, replay;
  std::optional<int> samples_per_pixel, replicates;
  RunOptions run;
  bool is_quiet = false, is_strict = false, is_in_sample_order = false;
};

/// The largest divisor of `samples` up to 8, so that a pixel's error is known where it can be.
int default_replicates(int samples) {
  constexpr int most = 8;
  for (int replicates = most; replicates > 1; --replicates)
    if (samples % replicates == 0) return replicates;
  return 1;
}

RenderSettings settings_for(const Options& options, const LoadedScene& loaded) {
  RenderSettings settings;
  settings.samples_per_pixel = options.samples_per_pixel.value_or(loaded.samples_per_pixel);
  if (settings.samples_per_pixel < 1)
    throw InputError(
        fmt::format("--spp {}: at least 1 sample a pixel is needed", settings.samples_per_pixel));
  settings.replicates = options.replicates.value_or(default_replicates(settings.samples_per_pixel));
  if (settings.replicates < 1)
    throw InputError(fmt::format("--replicates {}: at least 1 is needed", settings.replicates));
  if (settings.samples_per_pixel % settings.replicates != 0)
    throw InputError(fmt::format(
        "--replicates {}: {} samples a pixel cannot be split into {} equal parts\n"
        "choose a number that divides {}, or take --spp {}",
        settings.replicates, settings.samples_per_pixel, settings.replicates, settings.samples_per_pixel,
        (settings.samples_per_pixel / settings.replicates + 1) * std::int64_t(settings.replicates)));
  settings.seed = options.run.seed;
  settings.threads = options.run.threads;
  settings.isa = options.run.isa();
  settings.is_reordering = !options.is_in_sample_order;
  return settings;
}

/// The command line's integrator where it names one; the file's parameters hold where both mean the same.
IntegratorSettings integrator_for(const Options& options, const LoadedScene& loaded, Dialect dialect,
                                  std::vector<UnreadKey>& unread) {
  const std::string& name = options.integrator;
  if (loaded.integrator.family.empty())
    return name.empty() ? IntegratorSettings{} : integrator_from_name(name);
  std::vector<UnreadKey> unread_in_file;
  const IntegratorSettings in_file = make_integrator(loaded.integrator, dialect, unread_in_file);
  const bool is_named_so = name == loaded.integrator.type && !in_file.needs_lights();
  if (!name.empty() && !is_named_so) {
    const IntegratorSettings asked = integrator_from_name(name);
    if (asked.name != in_file.name) return asked;
  }
  unread.insert(unread.end(), unread_in_file.begin(), unread_in_file.end());
  return in_file;
}

Image to_image(const Film& film) {
  Image image;
  image.width = film.width();
  image.height = film.height();
  const auto size = std::size_t(film.width()) * std::size_t(film.height());
  for (const char* name : {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"})
    image.channels.push_back({name, std::vector<float>(size)});
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      const Color<double> error = standard_error(pixel);
      const std::size_t at = std::size_t(y) * std::size_t(film.width()) + std::size_t(x);
      const std::array values{pixel.mean.r, pixel.mean.g, pixel.mean.b, error.r, error.g, error.b};
      for (std::size_t c = 0; c < values.size(); ++c) image.channels[c].values[at] = float(values[c]);
    }
  return image;
}

std::int64_t count_rendered(const Film& film) {
  std::int64_t count = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) count += film.at(x, y).count > 0;
  return count;
}

/// Of the scene file's text: to tell whether two images are of one scene.
std::uint64_t text_hash(std::string_view text) {
  std::uint64_t hash = text.size();
  for (const char c : text) hash = hash64(hash ^ std::uint8_t(c));
  return hash;
}

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t(usage.ru_maxrss) * 1024;
}

nlohmann::ordered_json stats(const Options& options, const RenderSettings& settings,
                             const SceneDesc& description, const LoadedScene& loaded,
                             const RenderResult& result, int threads) {
  const Color<double> mean = result.film.mean();
  nlohmann::ordered_json json;
  json["scene"] = options.scene_file;
  json["dialect"] = dialect_name(description.dialect);
  json["dialect_reason"] = description.dialect_reason;
  json["integrator"] = settings.integrator.name;
  if (const std::string_view heuristic = heuristic_name(settings.integrator); !heuristic.empty())
    json["heuristic"] = heuristic;
  json["light_sampler"] = settings.integrator.light_sampler();
  json["sampler"] = sampler_name(loaded.scene.sampler);
  json["spp"] = settings.samples_per_pixel;
  json["replicates"] = settings.replicates;
  json["seed"] = settings.seed;
  json["threads"] = threads;
  json["isa"] = isa_name(settings.isa);
  json["width"] = result.film.width();
  json["height"] = result.film.height();
  json["seconds_load"] = loaded.seconds_read;
  json["seconds_build"] = loaded.seconds_build;
  json["seconds_render"] = result.seconds;
  json["pixels_not_rendered"] =
      std::int64_t(result.film.width()) * result.film.height() - count_rendered(result.film);
  json["samples"] = result.counts.samples;
  json["samples_per_second"] = double(result.counts.samples) / result.seconds;
  json["camera_rays"] = result.counts.camera_rays;
  json["shadow_rays"] = result.counts.shadow_rays;
  json["bsdf_rays"] = result.counts.bsdf_rays;
  json["lane_occupancy"] = result.counts.lane_occupancy();
  json["invalid_samples"] = result.counts.invalid_samples;
  json["mean"] = {mean.r, mean.g, mean.b};
  json["mean_luminance"] = luminance(mean);
  json["triangles"] = loaded.scene.geometry.triangle_count();
  json["lights"] = loaded.scene.lights.count();
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

void warn(const Options& options, const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  if (options.is_strict)
    throw InputError(fmt::format("{}\n--strict makes warnings errors", fmt::join(warnings, "\n")));
  if (options.is_quiet) return;
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

/// As one word of a shell.
std::string shell_quoted(const std::string& text) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
  if (text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// The command line that computes the same samples as this one, for one of them.
std::string replay_command(const Options& options, const InvalidSample& sample) {
  std::string command = "etendue render " + shell_quoted(options.scene_file);
  const auto add = [&](std::string_view option, const auto& value) {
    command += fmt::format(" {} {}", option, value);
  };
  if (!options.integrator.empty()) add("--integrator", options.integrator);
  if (!options.sampler.empty()) add("--sampler", options.sampler);
  if (!options.light_sampler.empty()) add("--light-sampler", options.light_sampler);
  if (options.samples_per_pixel) add("--spp", *options.samples_per_pixel);
  if (options.replicates) add("--replicates", *options.replicates);
  if (options.run.seed != 0) add("--seed", options.run.seed);
  if (!options.run.dialect_name.empty()) add("--dialect", options.run.dialect_name);
  add("--replay", fmt::format("{},{},{},{}", sample.x, sample.y, sample.replicate, sample.index));
  return command;
}

void report_invalid(const Options& options, const RenderResult& result) {
  if (result.counts.invalid_samples == 0) return;
  fmt::print(stderr,
             "warning: {} of {} samples were not finite, or were negative; each counts as 0 in its pixel\n",
             result.counts.invalid_samples, result.counts.samples);
  for (const InvalidSample& sample : result.invalid)
    fmt::print(stderr, "  pixel {},{} replicate {} sample {}: radiance {} {} {}\n", sample.x, sample.y,
               sample.replicate, sample.index, sample.radiance.r, sample.radiance.g, sample.radiance.b);
  fmt::print(
      stderr,
      "to see how the first of them came about (by the scalar kernel, which may round another way):\n  {}\n",
      replay_command(options, result.invalid.front()));
}

int run(const Options& options) {
  for (const std::string& output : options.outputs) check_writable(output);
  if (!options.stats_file.empty()) check_destination(options.stats_file);
  const SceneDesc description = read_nori_xml(options.scene_file, options.run.dialect());
  std::vector<std::string> written = options.outputs;
  if (!options.stats_file.empty()) written.push_back(options.stats_file);
  if (options.replay.empty()) check_overwrites_nothing(written, files_of(description, options.scene_file));
  const ThreadLimit thread_limit(options.run.threads);
  LoadedScene loaded = load_scene(description);
  if (!options.sampler.empty()) loaded.scene.sampler = sampler_from_name(options.sampler);
  RenderSettings settings = settings_for(options, loaded);
  std::vector<UnreadKey> unread;
  settings.integrator = integrator_for(options, loaded, description.dialect, unread);
  if (!options.light_sampler.empty())
    settings.integrator = with_light_sampler(settings.integrator, options.light_sampler);
  if (settings.integrator.needs_lights()) check_has_light(description, loaded.scene);
  if (const std::string unseen = unseen_lights(settings.integrator, loaded.scene.lights.dirac_count());
      !unseen.empty())
    loaded.warnings.push_back(unseen);
  for (const UnreadKey& key : unread) loaded.warnings.push_back(key.message);
  warn(options, loaded.warnings);
  if (!options.replay.empty()) {
    const SampleId sample = sample_id_from_text(options.replay);
    if (!written.empty())
      fmt::print(stderr, "warning: --replay computes one sample; nothing is written to {}\n",
                 fmt::join(written, ", "));
    fmt::print("{}", describe(loaded.scene, sample, replay(loaded.scene, settings, sample)));
    return done;
  }
  const int threads = options.run.threads > 0 ? options.run.threads : available_threads();
  if (!options.is_quiet)
    fmt::print(stderr, "{}: {} ({}), {}x{}, {} samples a pixel in {} replicates, {}, {} threads, {}\n",
               options.scene_file, dialect_name(description.dialect), description.dialect_reason,
               loaded.scene.camera.width_px, loaded.scene.camera.height_px, settings.samples_per_pixel,
               settings.replicates, settings.integrator.name, threads, isa_name(settings.isa));

  catch_interrupts();
  const RenderResult result = [&] {
    Progress progress("render", options.is_quiet);
    return render(
        loaded.scene, settings, [&](double fraction) { progress.update(fraction); }, &stop_requested);
  }();
  report_invalid(options, result);

  Image image = to_image(result.film);
  image.metadata = {{"scene", options.scene_file},
                    {"sceneHash", fmt::format("{:016x}", text_hash(description.root.location.source->text))},
                    {"seed", std::to_string(settings.seed)},
                    {"replicates", fmt::format("0-{}", settings.replicates - 1)},
                    {"samplesPerPixel", std::to_string(settings.samples_per_pixel)},
                    {"integrator", std::string(settings.integrator.name)},
                    {"isa", std::string(isa_name(settings.isa))},
                    {"dialect", std::string(dialect_name(description.dialect))},
                    {"sampler", std::string(sampler_name(loaded.scene.sampler))},
                    {"software", "Etendue " ETENDUE_VERSION}};
  const std::int64_t pixels = std::int64_t(image.width) * image.height,
                     rendered = count_rendered(result.film);
  if (result.is_interrupted)
    image.metadata.emplace_back("pixelsNotRendered", std::to_string(pixels - rendered));
  if (const std::string_view heuristic = heuristic_name(settings.integrator); !heuristic.empty())
    image.metadata.emplace_back("heuristic", heuristic);
  if (const std::string_view light_sampler = settings.integrator.light_sampler(); !light_sampler.empty())
    image.metadata.emplace_back("lightSampler", light_sampler);
  for (const std::filesystem::path output : options.outputs)
    image_format(output) == ImageFormat::png ? write_png(output, image) : write_exr(output, image);
  if (!options.stats_file.empty())
    write_text_file(options.stats_file,
                    stats(options, settings, description, loaded, result, threads).dump(2) + "\n");
  if (!options.is_quiet)
    fmt::print(stderr, "{} in {}: {:.1f} million samples a second\n",
               result.is_interrupted ? "interrupted" : "done", duration_text(result.seconds),
               1e-6 * double(result.counts.samples) / result.seconds);
  if (result.is_interrupted && !options.is_quiet)
    fmt::print(
        stderr,
        "saved {} of {} pixels; the others have radiance 0 and a standard error that is not a number\n",
        rendered, pixels);
  return result.is_interrupted ? interrupted : done;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("render", "Render a scene to EXR and PNG images");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene_file, "Scene file (XML of the Nori family)")->required();
  command
      ->add_option("-o,--output", options->outputs,
                   "Image to write, .exr (radiance and its standard error) or .png (sRGB); may be repeated")
      ->allow_extra_args(false);
  command->add_option("--integrator", options->integrator, "Instead of the file's; see etendue info");
  command->add_option("--sampler", options->sampler, "Instead of the file's: independent or sobol");
  command->add_option("--light-sampler", options->light_sampler,
                      "How lights are chosen, instead of the integrator's way: uniform, power or all");
  command->add_option("--spp", options->samples_per_pixel, "Samples a pixel in all, instead of the file's")
      ->check(whole_number(std::numeric_limits<int>::max()));
  command
      ->add_option("--replicates", options->replicates,
                   "Independent parts that the samples of a pixel are split into, from which its error is "
                   "estimated; must divide --spp [largest divisor up to 8]")
      ->check(whole_number(std::numeric_limits<int>::max()));
  add_run_options(*command, options->run);
  command->add_option("--stats", options->stats_file, "JSON file for settings, times and counts");
  command->add_option("--replay", options->replay,
                      "X,Y,REPLICATE,SAMPLE: compute only this sample, and print each step of it");
  command->add_flag("--quiet", options->is_quiet,
                    "No progress and no warnings about the scene; bad samples are still reported");
  command->add_flag("--strict", options->is_strict, "Warnings, such as an unknown key, are errors");
  command->add_flag("--sample-order", options->is_in_sample_order,
                    "Trace shadow rays in sample order, not aimed: slower, the same image");
  command->callback([options, &exit_code] {
    if (options->outputs.empty() && options->replay.empty()) throw CLI::RequiredError("--output");
    exit_code = run(*options);
  });
}

}  // namespace etendue::app

#include "render_options.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <string_view>

namespace etendue::app {

namespace {

bool is_known(const Object& integrator) {
  const std::vector<Plugin>& plugins = integrator_plugins();
  return std::any_of(plugins.begin(), plugins.end(),
                     [&](const Plugin& plugin) { return plugin.name == integrator.type; });
}

/// As one word of a shell.
std::string shell_quoted(const std::string& text) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
  if (text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// The command line's integrator where it names one, else the file's, else `path`.
IntegratorSettings integrator_named(const std::string& name, const LoadedScene& loaded, Dialect dialect,
                                    std::vector<std::string>& warnings) {
  const Object& in_file = loaded.integrator;
  if (in_file.family.empty()) return integrator_from_name(name.empty() ? "path" : name);
  const auto pass_over = [&](const std::string& why) {
    const IntegratorSettings asked = integrator_from_name(name);
    warnings.push_back(
        format_message(in_file.type_location, why, "taken in its place: --integrator " + name));
    return asked;
  };
  if (!name.empty() && !is_known(in_file))
    return pass_over(fmt::format("unknown integrator '{}'", in_file.type));
  std::vector<UnreadKey> unread;
  IntegratorSettings own;
  try {
    own = make_integrator(in_file, dialect, unread);
  } catch (const InputError&) {
    if (name.empty()) throw;
    return name == in_file.type ? pass_over("this integrator has a key that is missing or bad")
                                : integrator_from_name(name);
  }
  const bool is_named_so = name == in_file.type && !own.needs_lights();
  if (!name.empty() && !is_named_so) {
    const IntegratorSettings asked = integrator_from_name(name);
    if (asked.name != own.name) return asked;
  }
  for (const UnreadKey& key : unread) warnings.push_back(key.message);
  return own;
}

enum class Ends { excluded, included };

/// For CLI11's check().
std::function<std::string(const std::string&)> share(Ends upper) {
  return [upper](const std::string& text) {
    double share = 0;
    const bool is_share = CLI::detail::lexical_cast(text, share) && share > 0 &&
                          (upper == Ends::included ? share <= 1 : share < 1);
    return is_share ? std::string() : fmt::format("'{}' is not a number between 0 and 1", text);
  };
}

}  // namespace

void add_integrator_options(CLI::App& command, IntegratorOptions& options) {
  const auto number = whole_number(std::numeric_limits<int>::max());
  command.add_option("--integrator", options.name,
                     "Instead of the file's; where neither names one, path. See etendue info");
  command.add_option("--light-sampler", options.light_sampler,
                     "How lights are chosen, instead of the integrator's way: uniform, power, all or tree");
  command.add_option("--technique", options.technique,
                     "Where on a light its samples lie, instead of the integrator's way: area, "
                     "solid_angle, projected, ltc or auto");
  command
      .add_option(
          "--candidates", options.candidates,
          "Of how many candidates each light sample at the first vertex is one, chosen by what they "
          "would add; 1 to 1024 [path, direct_light: what a pilot finds to suit the scene; others: 1]")
      ->check(number);
  command
      .add_option("--shadow-rays", options.shadow_rays,
                  "Light samples at the first vertex, each with a shadow ray; 1 to 65536 "
                  "[path, direct_light: 1 or 4, as a pilot finds; others: 1, or as the keys of the file say]")
      ->check(number);
  command
      .add_option("--bsdf-samples", options.bsdf_samples,
                  "Directions from the BSDF at the first vertex, for path integrators each with a path of "
                  "its own behind it; 1 to 65536 [path: 1, 2, 4 or 8, as a pilot finds; others: 1, or as the "
                  "keys of the file say]")
      ->check(number);
  command.add_option("--weights", options.heuristic,
                     "How light samples and BSDF samples share light that both find: balance, power, "
                     "maximum, compensated or optimal "
                     "[path, direct_light: power; others: balance; or the file's]");
}

void add_render_options(CLI::App& command, RenderOptions& options) {
  command.add_option("SCENE", options.scene_file, "Scene file (XML of the Nori family)")->required();
  command
      .add_option(
          "-o,--output", options.outputs,
          "Image to write, .exr (radiance, its standard error and interval) or .png (sRGB); may be repeated")
      ->allow_extra_args(false);
  command.add_option("--sampler", options.sampler, "Instead of the file's: independent or sobol");
  add_integrator_options(command, options.integrator);
  command.add_option(
      "--plugin", options.plugin,
      "Shared library with integrators of your own (docs/course.md), of which --integrator names "
      "one; where it has only one, that");
  command.add_option("--spp", options.samples_per_pixel, "Samples a pixel in all, instead of the file's")
      ->check(whole_number(std::numeric_limits<int>::max()));
  command
      .add_option(
          "--replicates", options.replicates,
          "Alike parts that the samples of a pixel are split into, from which its error is estimated; "
          "must divide --spp [the smallest divisor of at least 8 and at least spp / 64]")
      ->check(whole_number(std::numeric_limits<int>::max()));
  command.add_option(
      "--replicates-by", options.replicates_by,
      "block: consecutive samples of one sequence, for the least error; scrambling: a sequence "
      "each, for intervals that are exact rather than careful [block]");
  command
      .add_option("--confidence", options.confidence,
                  "How often intervals are to hold the true value, between 0 and 1 [0.95]")
      ->check(share(Ends::excluded));
  CLI::Option* spp = command.get_option("--spp");
  CLI::Option* replicates = command.get_option("--replicates");
  CLI::Option* error =
      command
          .add_option(
              "--error", options.relative_error,
              "As many samples as it takes for errors (with --confidence) to be at most this share of a "
              "pixel (or of 1 % of the image's mean, where that is more): 0.01. Pilots tell; --spp is the "
              "most")
          ->check(positive_number())
          ->excludes(replicates);
  command
      .add_option("--of", options.share_within, "In what share of the pixels --error is to be kept [0.99]")
      ->check(share(Ends::included))
      ->needs(error);
  command
      .add_option(
          "--time", options.seconds,
          "As many samples as can be rendered in so many seconds, pilots counted, reading the scene not")
      ->check(positive_number())
      ->excludes(replicates)
      ->excludes(spp)
      ->excludes(error);
  command.add_flag(
      "--adaptive", options.is_adaptive,
      "Share the samples of --spp (then an average, 16 at least) or --time among the pixels by their "
      "errors, which a pilot of an eighth of them tells; with --error each pixel takes what it needs");
  command
      .add_option("--region", options.regions,
                  "NAME=X0,Y0,X1,Y1: say mean, error and checks of these pixels (X1 and Y1 are not of them) "
                  "too, in words and in --stats; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option(
          "--layers", options.layers,
          "LIST: parts of the image, and what other tools ask for, as layers of the EXR, with commas "
          "between: light,technique,depth, position,distance,normal,albedo,id,samples,variance_share. "
          "See etendue info")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_flag("--noise", options.is_noise_told,
                   "Say which lights and techniques the variance comes from, and of which it is infinite, in "
                   "words and in --stats");
  add_run_options(command, options.run);
  command.add_option("--stats", options.stats_file, "JSON file for settings, times and counts");
  command.add_option("--replay", options.replay,
                     "X,Y,REPLICATE,SAMPLE: compute only this sample, and print each step of it");
  command.add_flag(
      "--quiet", options.is_quiet,
      "No progress and no warnings about the file; what makes an image wrong or black, bad samples, and "
      "images that went to another name, are still reported");
  command.add_flag("--strict", options.is_strict,
                   "Warnings, such as an unknown key or a lamp that lights nothing, are errors; harmless "
                   "findings are not");
  command.add_flag("--sample-order", options.is_in_sample_order,
                   "Trace shadow rays in sample order, not aimed: slower, the same image");
  command.add_flag(
      "--watertight", options.is_watertight,
      "Let no ray pass between triangles that share an edge, where else a few in 1e7 do: about a "
      "seventh slower");
}

RenderSettings settings_for(const RenderOptions& options, const LoadedScene& loaded) {
  RenderSettings settings;
  settings.samples_per_pixel = options.samples_per_pixel.value_or(loaded.samples_per_pixel);
  settings.replicates = options.replicates;
  if (!options.replicates_by.empty()) settings.replicates_by = replicates_by_from_name(options.replicates_by);
  settings.seed = options.run.seed;
  settings.threads = options.run.threads;
  settings.isa = options.run.isa();
  settings.is_reordering = !options.is_in_sample_order;
  return settings;
}

IntegratorSettings integrator_for(const IntegratorOptions& options, const LoadedScene& loaded,
                                  Dialect dialect, std::vector<std::string>& warnings) {
  IntegratorSettings settings = integrator_named(options.name, loaded, dialect, warnings);
  if (!options.light_sampler.empty()) settings = with_light_sampler(settings, options.light_sampler);
  if (!options.technique.empty()) settings = with_light_technique(settings, options.technique);
  if (options.candidates) settings = with_candidates(settings, *options.candidates);
  if (options.shadow_rays) settings = with_shadow_rays(settings, *options.shadow_rays);
  if (options.bsdf_samples) settings = with_bsdf_samples(settings, *options.bsdf_samples);
  if (!options.heuristic.empty()) settings = with_heuristic(settings, options.heuristic);
  return settings;
}

std::string replay_command(const RenderOptions& options, const InvalidSample& sample) {
  std::string command = "etendue render " + shell_quoted(options.scene_file);
  const auto add = [&](std::string_view option, const auto& value) {
    command += fmt::format(" {} {}", option, value);
  };
  const IntegratorOptions& integrator = options.integrator;
  if (!options.plugin.empty()) add("--plugin", shell_quoted(options.plugin));
  if (!integrator.name.empty()) add("--integrator", integrator.name);
  if (!options.sampler.empty()) add("--sampler", options.sampler);
  if (!integrator.light_sampler.empty()) add("--light-sampler", integrator.light_sampler);
  if (!integrator.technique.empty()) add("--technique", integrator.technique);
  if (integrator.candidates) add("--candidates", *integrator.candidates);
  if (integrator.shadow_rays) add("--shadow-rays", *integrator.shadow_rays);
  if (integrator.bsdf_samples) add("--bsdf-samples", *integrator.bsdf_samples);
  if (!integrator.heuristic.empty()) add("--weights", integrator.heuristic);
  if (options.samples_per_pixel) add("--spp", *options.samples_per_pixel);
  if (options.replicates) add("--replicates", *options.replicates);
  if (!options.replicates_by.empty()) add("--replicates-by", options.replicates_by);
  if (options.run.seed != 0) add("--seed", options.run.seed);
  if (!options.run.dialect_name.empty()) add("--dialect", options.run.dialect_name);
  if (options.is_watertight) command += " --watertight";
  add("--replay", fmt::format("{},{},{},{}", sample.x, sample.y, sample.replicate, sample.index));
  return command;
}

}  // namespace etendue::app

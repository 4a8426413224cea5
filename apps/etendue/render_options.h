// The command line of `etendue render`, and what it and the scene file settle between them.
#pragma once

#include "render/render.h"
#include "run_options.h"
#include "scene/load_scene.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace etendue::app {

/// Which integrator, and what it is to do in another way than by itself.
struct IntegratorOptions {
  std::string name, light_sampler, technique, heuristic;
  std::optional<int> candidates, shadow_rays, bsdf_samples;
};

struct RenderOptions {
  std::string scene_file;
  std::vector<std::string> outputs;
  std::string sampler, replicates_by, stats_file, replay, plugin;
  std::vector<std::string> regions;  ///< As they were given.
  std::vector<std::string> layers;   ///< Names of known_layers.
  std::optional<int> samples_per_pixel, replicates;
  double confidence = 0.95;
  std::optional<double> seconds, relative_error;  ///< Instead of a number of samples.
  double share_within = 0.99;                     ///< Of the pixels, for relative_error.
  IntegratorOptions integrator;
  RunOptions run;
  bool is_quiet = false, is_strict = false, is_in_sample_order = false, is_watertight = false,
       is_adaptive = false, is_noise_told = false;
};

/// Adds --integrator and the options that change it. `options` must live as long as the command.
void add_integrator_options(CLI::App& command, IntegratorOptions& options);

/// `options` must live as long as the command.
void add_render_options(CLI::App& command, RenderOptions& options);

/// All but the integrator. Throws InputError with the option that does not fit.
RenderSettings settings_for(const RenderOptions& options, const LoadedScene& loaded);

/// The command line's integrator where it names one, else the file's, else `path`; the file's parameters hold
/// where both name the same. What is wrong with the file's integrator does not matter where the command line
/// names another. Throws InputError with what the options ask for and the integrator cannot do.
/// \param warnings gets what was passed over, and keys that nobody read
IntegratorSettings integrator_for(const IntegratorOptions& options, const LoadedScene& loaded,
                                  Dialect dialect, std::vector<std::string>& warnings);

/// The command line that computes the same samples as this one, for one of them.
std::string replay_command(const RenderOptions& options, const InvalidSample& sample);

}  // namespace etendue::app

// What a render says of itself: the JSON of --stats, warnings, bad samples.
#pragma once

#include "image_errors.h"
#include "lint/lint.h"
#include "pilots.h"
#include "render_layers.h"
#include "render_options.h"
#include "scenefile/scene_desc.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace etendue::app {

/// A render that has ended, and what it was made from.
struct Rendering {
  const RenderOptions& options;
  const SceneDesc& description;
  const LoadedScene& loaded;
  const RenderSettings& settings;
  const RenderLayers& layers;
  std::uint64_t scene_hash;
  RenderResult result;
  ImageErrors errors;
  Pilots pilots;

  /// On average, rounded, where pixels differ.
  int samples_per_pixel() const;
  std::int64_t pixels() const { return std::int64_t(result.film.width()) * result.film.height(); }
  std::int64_t pixels_rendered() const;
  const PathRules* light_rules() const;  ///< Null where lights are not sampled.
};

nlohmann::ordered_json stats(const Rendering& rendering);

/// On stderr; with --quiet only findings that are not harmless. Throws InputError with --strict where there
/// is anything but harmless findings.
void warn(const RenderOptions& options, const std::vector<std::string>& warnings,
          const std::vector<Finding>& findings);

/// On stderr: the first bad samples, the object at which the first went wrong, and how to replay it.
void report_invalid(const Rendering& rendering);

/// On stderr: why an image is black, which error bars of 0 say nothing, and that of one replicate none is
/// known.
void report_dark(const Rendering& rendering, const LintSubject& subject);

}  // namespace etendue::app

#include "render_report.h"

#include "error_report.h"
#include "messages.h"
#include "noise_report.h"
#include "render/replay.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <string_view>
#include <sys/resource.h>

namespace etendue::app {

namespace {

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t(usage.ru_maxrss) * 1024;
}

/// "file:line:column: ", or nothing where that is not known.
std::string place_text(const Location& where) {
  if (!where.source) return "";
  const LineColumn at = line_and_column(where);
  return fmt::format("{}:{}:{}: ", where.source->path, at.line, at.column);
}

struct FindingLine {
  std::string text;
  Severity severity;
};

/// A line for each finding, but of many by one check only the first few.
std::vector<FindingLine> lines_of(const std::vector<Finding>& findings) {
  constexpr int most_alike = 3;
  std::vector<FindingLine> lines;
  std::map<std::string_view, int> counts;
  for (const Finding& finding : findings)
    if (++counts[finding.id] <= most_alike)
      lines.push_back({fmt::format("{}{} [{}]", place_text(finding.where), finding.problem, finding.id),
                       finding.severity});
  for (const auto& [id, count] : counts)
    if (count > most_alike) {
      const auto alike = std::find_if(findings.begin(), findings.end(),
                                      [&, id = id](const Finding& finding) { return finding.id == id; });
      lines.push_back(
          {fmt::format("{} more of the kind [{}]: etendue lint lists them", count - most_alike, id),
           alike->severity});
    }
  return lines;
}

/// The object at which the first invalid sample went wrong; empty where a replay does not show it.
std::string object_of_invalid(const Rendering& rendering) {
  const InvalidSample& first = rendering.result.invalid.first().front();
  const ScenePlaces& places = rendering.loaded.places;
  const SampleTrace trace =
      replay(rendering.loaded.scene, rendering.settings, {first.x, first.y, first.replicate, first.index});
  const auto is_bad = [](const Colorf& c) {
    const auto is_bad_channel = [](float x) { return !std::isfinite(x) || x < 0; };
    return is_bad_channel(c.r) || is_bad_channel(c.g) || is_bad_channel(c.b);
  };
  for (const SampleTrace::Vertex& vertex : trace.vertices) {
    const bool is_here =
        is_bad(vertex.radiance) || (vertex.bsdf_sample && is_bad(vertex.bsdf_sample->throughput));
    if (!is_here) continue;
    if (!vertex.surface)
      return vertex.kind == SampleTrace::Vertex::Kind::medium
                 ? fmt::format("vertex {}, in the medium", vertex.number)
                 : "a light at infinity";
    const auto geometry = std::size_t(vertex.surface->geometry);
    const ScenePlaces::Shape& shape = places.shapes[geometry];
    return fmt::format("vertex {}: {}the {}", vertex.number, place_text(shape.where), shape.name);
  }
  return "";
}

std::vector<Pixel> dark_pixels(const Film& film) {
  std::vector<Pixel> dark;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      if (pixel.count > 0 && pixel.mean == Color<double>{0, 0, 0}) dark.push_back({x, y});
    }
  return dark;
}

/// What a pilot has tried, and how efficient each is relative to the usual budget.
nlohmann::ordered_json stats_of(const BudgetPilot& pilot) {
  nlohmann::ordered_json tried = nlohmann::ordered_json::array();
  for (const TriedBudget& each : pilot.tried)
    tried.push_back({{"light_samples", each.budget.light_samples},
                     {"candidates", each.budget.candidates},
                     {"glossy_candidates", each.budget.glossy_candidates},
                     {"bsdf_samples", each.budget.bsdf_samples},
                     {"error", each.error()},
                     {"relative_efficiency", each.gain_over(pilot.tried.front())}});
  return {{"pilot_seconds", pilot.seconds}, {"tried", tried}};
}

}  // namespace

std::int64_t Rendering::pixels_rendered() const {
  std::int64_t count = 0;
  for (int y = 0; y < result.film.height(); ++y)
    for (int x = 0; x < result.film.width(); ++x) count += result.film.at(x, y).count > 0;
  return count;
}

int Rendering::samples_per_pixel() const {
  if (!settings.allocation) return result.replicates * settings.samples_per_replicate();
  return int(std::lround(result.replicates * settings.allocation->mean()));
}

const PathRules* Rendering::light_rules() const {
  const PathRules* rules = settings.integrator.path_rules();
  return rules && rules->light_samples() ? rules : nullptr;
}

nlohmann::ordered_json stats(const Rendering& rendering) {
  const RenderSettings& settings = rendering.settings;
  const LoadedScene& loaded = rendering.loaded;
  const RenderResult& result = rendering.result;
  const Color<double> mean = result.film.mean();
  nlohmann::ordered_json json;
  json["scene"] = rendering.options.scene_file;
  json["scene_hash"] = fmt::format("{:016x}", rendering.scene_hash);
  json["dialect"] = dialect_name(rendering.description.dialect);
  json["dialect_reason"] = rendering.description.dialect_reason;
  json["integrator"] = settings.integrator.name;
  if (const auto* single = std::get_if<SingleRays>(&settings.integrator.rules))
    json["plugin"] = single->plugin;
  if (const std::string_view heuristic = heuristic_name(settings.integrator); !heuristic.empty())
    json["heuristic"] = heuristic;
  json["light_sampler"] = settings.integrator.light_sampler();
  json["technique"] = settings.integrator.light_technique();
  const PathRules* rules = rendering.light_rules();
  json["light_samples"] = rules ? rules->light_count(0) : 0;
  json["candidates"] = rules ? rules->candidates(0) : 0;
  json["glossy_candidates"] = rules ? rules->glossy_candidates(0) : 0;
  const PathRules* path_rules = settings.integrator.path_rules();
  json["bsdf_samples"] = path_rules ? path_rules->bsdf_samples(0) : 0;
  if (const auto& pilot = rendering.pilots.budget) json["light_budget"] = stats_of(*pilot);
  if (const auto& pilot = rendering.pilots.weights)
    json["optimal_weights"] = {{"pilot_seconds", pilot->seconds},
                               {"alpha", {pilot->alpha.r, pilot->alpha.g, pilot->alpha.b}},
                               {"variance_ratio", pilot->variance_ratio}};
  json["sampler"] = sampler_name(loaded.scene.sampler);
  json["spp"] = rendering.samples_per_pixel();
  if (const auto& allocation = settings.allocation)
    json["adaptive"] = {{"pilot_samples_per_pixel", rendering.pilots.allocation->samples_per_pixel},
                        {"pilot_seconds", rendering.pilots.allocation->seconds},
                        {"least_samples_per_pixel", std::int64_t(result.replicates) * allocation->least()},
                        {"most_samples_per_pixel", std::int64_t(result.replicates) * allocation->most()},
                        {"mean_samples_per_pixel", result.replicates * allocation->mean()}};
  json["replicates"] = result.replicates;
  json["replicates_by"] = replicates_by_name(settings.replicates_by);
  json["seed"] = settings.seed;
  json["threads"] = settings.threads > 0 ? settings.threads : available_threads();
  json["isa"] = isa_name(settings.isa);
  json["width"] = result.film.width();
  json["height"] = result.film.height();
  json["seconds_load"] = loaded.seconds_read;
  json["seconds_build"] = loaded.seconds_build;
  json["seconds_render"] = result.seconds;
  json["interrupted"] = result.is_interrupted;
  json["pixels_not_rendered"] = rendering.pixels() - rendering.pixels_rendered();
  json["samples"] = result.counts.samples;
  json["samples_per_second"] = double(result.counts.samples) / result.seconds;
  json["camera_rays"] = result.counts.camera_rays;
  json["outline_rays"] = result.counts.outline_rays;
  json["shadow_rays"] = result.counts.shadow_rays;
  json["bsdf_rays"] = result.counts.bsdf_rays;
  json["lane_occupancy"] = result.counts.lane_occupancy();
  json["invalid_samples"] = result.invalid.count();
  json["mean"] = {mean.r, mean.g, mean.b};
  json["mean_luminance"] = luminance(mean);
  add_error_stats(rendering, json);
  add_noise_stats(rendering, json);
  json["triangles"] = loaded.scene.geometry.triangle_count();
  json["lights"] = loaded.scene.lights.count();
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

void warn(const RenderOptions& options, const std::vector<std::string>& warnings,
          const std::vector<Finding>& findings) {
  std::vector<std::string> worth_an_error = warnings, harmless;
  for (const auto& [text, severity] : lines_of(findings))
    (severity == Severity::harmless ? harmless : worth_an_error).push_back(text);
  if (options.is_strict && !worth_an_error.empty())
    throw InputError(fmt::format("{}\n--strict makes warnings errors", fmt::join(worth_an_error, "\n")));
  for (std::size_t k = options.is_quiet ? warnings.size() : 0; k < worth_an_error.size(); ++k)
    say("warning: {}\n", worth_an_error[k]);
  if (options.is_quiet) return;
  for (const std::string& text : harmless) say("warning: {}\n", text);
}

void report_invalid(const Rendering& rendering) {
  const RenderResult& result = rendering.result;
  if (result.invalid.count() == 0) return;
  say("warning: {} of {} samples were not finite, or were negative; each counts as 0 in its pixel\n",
      result.invalid.count(), result.counts.samples);
  for (const InvalidSample& sample : result.invalid.first())
    say("  pixel {},{} replicate {} sample {}: radiance {} {} {}\n", sample.x, sample.y, sample.replicate,
        sample.index, sample.radiance.r, sample.radiance.g, sample.radiance.b);
  if (const std::string object = object_of_invalid(rendering); !object.empty())
    say("the first went wrong at {}\n", object);
  RenderOptions options = rendering.options;
  if (rendering.pilots.samples) options.samples_per_pixel = rendering.settings.samples_per_pixel;
  if (const auto& allocation = rendering.settings.allocation) {
    // A pixel's samples are those of a render that gives all pixels as many.
    const InvalidSample& first = result.invalid.first().front();
    options.replicates = rendering.settings.replicates;
    options.samples_per_pixel = *options.replicates * allocation->at(first.x, first.y);
  }
  say("to see how the first of them came about (by the scalar kernel, which may round another way):\n  {}\n",
      replay_command(options, result.invalid.first().front()));
}

void report_dark(const Rendering& rendering, const LintSubject& subject) {
  if (rendering.result.is_fragment) return;
  const std::vector<Pixel> dark = dark_pixels(rendering.result.film);
  if (std::int64_t(dark.size()) == rendering.pixels() && rendering.result.invalid.count() == 0) {
    say("warning: the image is black: {}\n", reason_of_black_image(subject));
    return;
  }
  if (rendering.options.is_quiet) return;
  if (rendering.result.replicates == 1)
    say("the error of the image is not known: it takes two replicates to tell (--replicates), and the stderr "
        "layers "
        "hold not-a-number\n");
  if (const std::size_t lit = count_lit_pixels(subject, dark); lit > 0)
    say("about {} of {} black pixels show surfaces that light does reach, but no sample found it: there the "
        "error is "
        "not 0, as the stderr layers say; the interval layers say how much light there may be\n",
        lit, dark.size());
}

}  // namespace etendue::app

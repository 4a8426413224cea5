#include "noise_report.h"

#include "messages.h"
#include "stats/pareto_tail.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::app {

namespace {

struct NoiseRow {
  std::string light;
  std::string_view technique;
  double share;
  ParetoTail tail;
};

/// Of the parts that any sample has met, the largest share first.
std::vector<NoiseRow> noise_rows(const Rendering& rendering) {
  std::vector<NoiseRow> rows;
  const std::vector<PartNoise>& noise = rendering.result.noise;
  for (std::size_t k = 0; k < noise.size(); ++k)
    if (noise[k].largest.count() > 0)
      rows.push_back({rendering.layers.noise_lights.names[k / technique_layer_names.size()],
                      technique_layer_names[k % technique_layer_names.size()], noise[k].variance_share,
                      pareto_tail(noise[k].largest)});
  std::stable_sort(rows.begin(), rows.end(),
                   [](const NoiseRow& a, const NoiseRow& b) { return a.share > b.share; });
  return rows;
}

std::string name_of(const NoiseRow& row) {
  if (row.technique == "emission") return fmt::format("'{}', seen by the camera", row.light);
  return fmt::format("'{}' by {} samples", row.light, row.technique == "light" ? "light" : "BSDF");
}

/// Light samples by area, without weights: nothing bounds them where a lit surface meets a light.
bool is_without_bound(const Rendering& rendering, const NoiseRow& row) {
  const PathRules* rules = rendering.light_rules();
  return rules && row.technique == "light" && !rules->heuristic() &&
         rules->light_samples()->technique == LightTechnique::area;
}

}  // namespace

void add_noise_stats(const Rendering& rendering, nlohmann::ordered_json& json) {
  if (!rendering.settings.noise_parts) return;
  json["variance_share"] = nlohmann::ordered_json::array();
  for (const NoiseRow& row : noise_rows(rendering))
    json["variance_share"].push_back(
        {{"light", row.light},
         {"technique", row.technique},
         {"share", row.share},
         {"tail_slope", {{"slope", row.tail.slope}, {"low", row.tail.low}, {"high", row.tail.high}}}});
}

void report_noise(const Rendering& rendering) {
  if (!rendering.settings.noise_parts || rendering.options.is_quiet) return;
  const std::vector<NoiseRow> rows = noise_rows(rendering);
  if (!rows.empty() && !std::isnan(rows.front().share)) {
    constexpr std::size_t most_rows = 10;
    say("the variance of the image comes from\n");
    for (std::size_t k = 0; k < std::min(rows.size(), most_rows); ++k)
      say("  {:6.2f} %  {}\n", 100 * rows[k].share, name_of(rows[k]));
    double rest = 0;
    for (std::size_t k = most_rows; k < rows.size(); ++k) rest += rows[k].share;
    if (rows.size() > most_rows) say("  {:6.2f} %  {} others\n", 100 * rest, rows.size() - most_rows);
  }
  constexpr double least_share = 0.01;  // What adds less noise is no matter to anyone.
  for (const NoiseRow& row : rows)
    if (row.share >= least_share && row.tail.has_infinite_variance())
      say("{}: the density of its largest values falls as their power {:.2f} ({:.2f} to {:.2f}), above -3: "
          "{}\n",
          name_of(row), -row.tail.slope, -row.tail.high, -row.tail.low,
          is_without_bound(rendering, row)
              ? "the variance is infinite, and no error can be trusted: use --technique solid_angle, or an "
                "integrator with weights (path, mis)"
              : "few samples decide, and errors may be too small; more samples");
}

}  // namespace etendue::app

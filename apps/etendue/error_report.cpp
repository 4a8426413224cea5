#include "error_report.h"

#include "messages.h"
#include "pilots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace etendue::app {

namespace {

constexpr std::array<const char*, interval_rules> rule_names{"student_t", "neighbours", "rare_events",
                                                             "black", "unknown"};

std::array<double, interval_rules> shares_of_rules(const Rendering& rendering) {
  std::array<double, interval_rules> shares{};
  for (const PixelInterval& interval : rendering.errors.intervals) shares[std::size_t(interval.rule)] += 1;
  for (double& share : shares) share /= double(rendering.pixels());
  return shares;
}

/// Half-widths over max(pixel, 1 % of the image's mean), by luminance, where they are known.
std::vector<double> relative_half_widths(const Rendering& rendering) {
  const Film& film = rendering.result.film;
  const double floor = 0.01 * luminance(film.mean());
  std::vector<double> widths;
  for (std::size_t at = 0; at < rendering.errors.intervals.size(); ++at) {
    const PixelInterval& interval = rendering.errors.intervals[at];
    if (interval.rule == IntervalRule::unknown) continue;
    const Color<double>& mean =
        film.at(int(at % std::size_t(film.width())), int(at / std::size_t(film.width()))).mean;
    const double width = interval.luminance_half_width / std::max(luminance(mean), floor);
    if (std::isfinite(width)) widths.push_back(width);
  }
  return widths;
}

nlohmann::ordered_json json_of(const RegionMean& mean) {
  const auto& [r, g, b] = mean.channels;
  const KnownMean& y = mean.luminance;
  return {{"mean", {r.mean, g.mean, b.mean}},
          {"stderr", {r.error, g.error, b.error}},
          {"low", {r.interval.lower, g.interval.lower, b.interval.lower}},
          {"high", {r.interval.upper, g.interval.upper, b.interval.upper}},
          {"luminance",
           {{"mean", y.mean}, {"stderr", y.error}, {"low", y.interval.lower}, {"high", y.interval.upper}}}};
}

nlohmann::ordered_json json_of(const ConvergenceChecks& checks) {
  return {{"rise_by_largest", checks.rise_by_largest},
          {"error_slope", {{"slope", checks.slope}, {"low", checks.slope_low}, {"high", checks.slope_high}}},
          {"halves",
           {{"pixels", checks.pixels_tested()},
            {"p_values", checks.p_values},
            {"below_1_percent", checks.p_values_below_1_percent}}}};
}

/// More pixels differ between the halves than chance makes in one of a million images.
bool do_halves_differ(const ConvergenceChecks& checks) {
  const double expected = 0.01 * double(checks.pixels_tested());
  return double(checks.p_values_below_1_percent) > expected + 5 * std::sqrt(expected) + 5;
}

void report_checks(const std::string& name, const ConvergenceChecks& checks) {
  if (checks.rise_by_largest > 0.01)
    say("{}: were the replicate that raises the mean most drawn once more, the mean would rise by {}\n", name,
        percent_text(checks.rise_by_largest));
  if (checks.slope_low > -0.5)
    say("{}: the error falls as samples^{:.2f} ({:.2f} to {:.2f}), slower than the root: few samples decide, "
        "or "
        "the variance is infinite\n",
        name, checks.slope, checks.slope_low, checks.slope_high);
  if (do_halves_differ(checks))
    say("{}: two halves of the samples differ at the 1 % level in {} of pixels\n", name,
        percent_text(double(checks.p_values_below_1_percent) / double(checks.pixels_tested())));
}

void report_intervals(const Rendering& rendering) {
  const std::array shares = shares_of_rules(rendering);
  const auto percent = [&](IntervalRule rule) { return 100 * shares[std::size_t(rule)]; };
  std::string text =
      fmt::format("{:g} % intervals: {:.1f} % of pixels by their own spread, {:.1f} % by their neighbours'",
                  100 * rendering.options.confidence, percent(IntervalRule::student_t),
                  percent(IntervalRule::neighbours));
  if (const double rare = shares[std::size_t(IntervalRule::rare_events)]; rare > 0)
    text += fmt::format("; {} lie near rare events and cannot be trusted", percent_text(rare));
  if (const double black = shares[std::size_t(IntervalRule::black)]; black > 0)
    text += fmt::format("; {} met no light", percent_text(black));
  say("{}\n", text);
}

}  // namespace

void add_error_stats(const Rendering& rendering, nlohmann::ordered_json& json) {
  nlohmann::ordered_json& error = json["error"];
  error["confidence"] = rendering.options.confidence;
  if (std::vector<double> widths = relative_half_widths(rendering); !widths.empty()) {
    const auto middle = widths.begin() + std::ptrdiff_t(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    error["median_relative"] = *middle;
    error["share_below_1_percent"] =
        double(std::count_if(widths.begin(), widths.end(), [](double width) { return width < 0.01; })) /
        double(rendering.pixels());
  }
  if (rendering.pilots.samples) {
    error["pilot"] = {{"seconds", rendering.pilots.samples->seconds},
                      {"samples", rendering.pilots.samples->samples}};
    if (const std::optional<ErrorGoal> goal = error_goal(rendering.options))
      error["goal"] = {{"relative", goal->relative},
                       {"share", goal->share},
                       {"reached", share_within(rendering.result.film, rendering.errors.intervals, *goal)},
                       {"bars_over_errors", rendering.pilots.samples->bars_over_errors}};
  }
  const std::array shares = shares_of_rules(rendering);
  for (std::size_t rule = 0; rule < shares.size(); ++rule) error["trust"][rule_names[rule]] = shares[rule];
  for (const RegionErrors& region : rendering.errors.regions) {
    json["regions"][region.name] = json_of(region.mean);
    json["checks"][region.name] = json_of(region.checks);
  }
}

void report_errors(const Rendering& rendering) {
  if (rendering.options.is_quiet || rendering.result.replicates < 2) return;
  report_intervals(rendering);
  if (const std::optional<ErrorGoal> goal = error_goal(rendering.options))
    say("{:.1f} % of pixels have a bar below {:g} %; {:g} % were asked for, of errors, and the bars are "
        "{:.1f} "
        "times as wide as these\n",
        100 * share_within(rendering.result.film, rendering.errors.intervals, *goal), 100 * goal->relative,
        100 * goal->share, rendering.pilots.samples->bars_over_errors);
  for (const RegionErrors& region : rendering.errors.regions) {
    const KnownMean& mean = region.mean.luminance;
    say("{}: mean luminance {:.6g} +- {:.2g}\n", region.name, mean.mean, mean.interval.upper - mean.mean);
    report_checks(region.name, region.checks);
  }
}

}  // namespace etendue::app

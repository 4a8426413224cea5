#include "pilots.h"

#include "interrupt.h"
#include "messages.h"
#include "render/check_settings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace etendue::app {

std::optional<ErrorGoal> error_goal(const RenderOptions& options) {
  if (!options.relative_error) return std::nullopt;
  return ErrorGoal{*options.relative_error, options.share_within, options.confidence};
}

namespace {

std::string budget_text(const LightBudget& budget) {
  const auto count = [](int number, std::string_view what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  std::string text = fmt::format("{} of {}", count(budget.light_samples, "light sample"),
                                 count(budget.candidates, "candidate"));
  if (budget.glossy_candidates != budget.candidates)
    text += fmt::format(" ({} where glossy)", budget.glossy_candidates);
  if (budget.bsdf_samples > 1) text += fmt::format(" and {} BSDF samples", budget.bsdf_samples);
  return text;
}

/// Nothing where a number of samples or candidates was asked for, or there is no choice.
std::optional<BudgetPilot> settle_budget(const RenderOptions& options, const Scene& scene,
                                         RenderSettings& settings) {
  const IntegratorSettings usual = settled(settings.integrator, scene.lights);
  std::optional<BudgetPilot> pilot;
  if (!options.integrator.shadow_rays && !options.integrator.bsdf_samples)
    pilot = light_budget_for(scene, settings, &stop_request);
  settings.integrator = pilot ? with_light_budget(settings.integrator, pilot->chosen) : usual;
  if (!pilot || options.is_quiet || pilot->chosen == pilot->tried.front().budget) return pilot;
  say("a pilot of {:.1f} s takes {} a camera ray, not {}: about {:.1f} times as efficient here\n",
      pilot->seconds, budget_text(pilot->chosen), budget_text(pilot->tried.front().budget), pilot->gain());
  return pilot;
}

/// Nothing where weights are not optimal, or no pilot can tell them.
std::optional<WeightPilot> settle_weights(const RenderOptions& options, const Scene& scene,
                                          RenderSettings& settings) {
  if (!needs_weight_pilot(scene, settings)) {
    if (heuristic_name(settings.integrator) == "optimal" && !options.is_quiet)
      say("note: weights 'optimal' are those of 'power' here: {}\n",
          scene.medium ? "their control variate knows of no medium"
                       : "the image is too small for a pilot to find their coefficient");
    return std::nullopt;
  }
  const std::optional<WeightPilot> pilot = optimal_alpha_for(scene, settings, &stop_request);
  if (!pilot) return pilot;
  settings.integrator = with_alpha(settings.integrator, pilot->alpha);
  if (options.is_quiet) return pilot;
  if (pilot->alpha == Colorf{0, 0, 0})
    say("a pilot of {:.1f} s finds nothing to gain by 'optimal': weights are those of 'power'\n",
        pilot->seconds);
  else
    say("a pilot of {:.1f} s finds weights that leave {:.0f} % of the variance of 'power'\n", pilot->seconds,
        100 * pilot->variance_ratio);
  return pilot;
}

int most_samples(const RenderOptions& options, const RenderSettings& settings) {
  if (options.samples_per_pixel && *options.samples_per_pixel < least_pilot_samples)
    throw InputError(
        fmt::format("--spp {} with --error: it is the most there may be, and pilots alone take {}",
                    *options.samples_per_pixel, least_pilot_samples));
  return int(std::min<std::int64_t>(most_samples_of_pixel(settings.integrator),
                                    options.samples_per_pixel.value_or(1 << 16)));
}

std::string range_text(const SampleAllocation& allocation, int replicates) {
  const std::int64_t least = std::int64_t(replicates) * allocation.least(),
                     most = std::int64_t(replicates) * allocation.most();
  return fmt::format("{} to {} samples a pixel, {:.1f} on average", least, most,
                     replicates * allocation.mean());
}

void say_what_pilots_ask(const Pilot& pilot, const std::string& samples, bool is_for_error) {
  say("pilots of {:.1f} s ask for {}{}\n", pilot.seconds, samples,
      pilot.is_dark    ? ": they have met no light"
      : !pilot.is_most ? ""
      : is_for_error   ? ", the most there may be: what was asked for is not reached"
                       : ", the most there may be: the time is not used up");
}

/// Nothing where a number of samples was asked for.
std::optional<Pilot> settle_samples(const RenderOptions& options, const Scene& scene,
                                    RenderSettings& settings) {
  const std::optional<ErrorGoal> goal = error_goal(options);
  if (!goal && !options.seconds) return std::nullopt;
  const int most = most_samples(options, settings);
  if (!options.is_quiet) say("pilots find out how many samples a pixel that takes ...\n");
  const Pilot pilot = goal ? samples_for_error(scene, settings, *goal, most, &stop_request)
                           : samples_for_time(scene, settings, *options.seconds, most, &stop_request);
  if (pilot.is_interrupted) return pilot;
  settings.samples_per_pixel = pilot.samples_per_pixel;
  if (!options.is_quiet)
    say_what_pilots_ask(pilot, fmt::format("{} samples a pixel", settings.samples_per_pixel),
                        goal.has_value());
  return pilot;
}

/// Of --error with --adaptive: how many samples, and where.
void settle_samples_of_pixels(const RenderOptions& options, const ErrorGoal& goal, const Scene& scene,
                              RenderSettings& settings, Pilots& pilots) {
  const int most = most_samples(options, settings);
  if (!options.is_quiet) say("pilots find out how many samples each pixel takes ...\n");
  const ErrorAllocation found = allocation_for_error(scene, settings, goal, most, &stop_request);
  const double pixels = double(scene.camera.width_px) * double(scene.camera.height_px);
  pilots.samples = found.pilot;
  pilots.allocation =
      AllocationPilot{found.allocation, found.replicates,
                      int(std::lround(double(found.pilot.samples) / pixels)), found.pilot.seconds};
  if (!found.allocation) return;
  settings.samples_per_pixel = found.pilot.samples_per_pixel;
  settings.replicates = found.replicates;
  settings.allocation = found.allocation;
  if (!options.is_quiet)
    say_what_pilots_ask(found.pilot, range_text(*found.allocation, found.replicates), true);
}

/// Of --adaptive without --error; else nothing.
std::optional<AllocationPilot> settle_allocation(const RenderOptions& options, const Scene& scene,
                                                 RenderSettings& settings) {
  if (!options.is_adaptive) return std::nullopt;
  AllocationPilot pilot = allocation_for(scene, settings, &stop_request);
  if (!pilot.allocation) return pilot;
  settings.replicates = pilot.replicates;
  settings.allocation = pilot.allocation;
  if (!options.is_quiet)
    say("a pilot of {} samples a pixel, of {:.1f} s, shares out {}\n", pilot.samples_per_pixel, pilot.seconds,
        range_text(*pilot.allocation, pilot.replicates));
  return pilot;
}

}  // namespace

Pilots settle_by_pilots(const RenderOptions& options, const Scene& scene, RenderSettings& settings) {
  Pilots pilots;
  pilots.budget = settle_budget(options, scene, settings);
  pilots.weights = settle_weights(options, scene, settings);
  pilots.is_interrupted = stop_request.soon;
  if (pilots.is_interrupted) return pilots;
  const std::optional<ErrorGoal> goal = error_goal(options);
  const bool is_each_by_itself = goal && options.is_adaptive;
  if (is_each_by_itself)
    settle_samples_of_pixels(options, *goal, scene, settings, pilots);
  else if (options.replay.empty())
    pilots.samples = settle_samples(options, scene, settings);
  if (pilots.samples) pilots.is_interrupted = pilots.samples->is_interrupted;
  if (!pilots.is_interrupted && !is_each_by_itself)
    pilots.allocation = settle_allocation(options, scene, settings);
  if (pilots.allocation) pilots.is_interrupted = !pilots.allocation->allocation;
  return pilots;
}

}  // namespace etendue::app

#include "render/light_budget.h"

#include "base/clock.h"
#include "render/pilot_squares.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

constexpr int samples_of_budget = 16;  // A pixel, in each of the two renders.
constexpr double better_by = 1.5;
constexpr int pixels_a_budget_square = 1024, most_budget_squares = 2048;

/// About how long a sample takes, in seconds, as measured over scenes of 1e1 to 1e6 triangles: two thirds of
/// it for what is seen, the rest for light samples.
double seconds_of_sample(const Scene& scene, std::int64_t facets, const LightBudget& budget) {
  constexpr std::int64_t swarm = 1 << 16;  // From there on each candidate waits for memory.
  const double ray =
      30e-9 + 4e-9 * std::log2(double(std::max<std::int64_t>(scene.geometry.triangle_count(), 1)));
  const double candidate = facets < swarm ? 35e-9 : 130e-9;
  return 2 * ray + budget.light_samples * (ray + budget.candidates * candidate);
}

/// Mean absolute difference of the two replicates of all pixels; none where it was stopped.
std::optional<double> error_of(PilotSquares& squares, const RenderSettings& settings,
                               const StopRequest* stop) {
  const auto means = squares.render(settings, 2, samples_of_budget, stop);
  if (!means) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i < means->size(); i += 2)
    sum += std::abs(luminance((*means)[i]) - luminance((*means)[i + 1]));
  return sum / double(means->size() / 2);
}

}  // namespace

std::optional<BudgetPilot> light_budget_for(const Scene& scene, const RenderSettings& settings,
                                            const StopRequest* stop) {
  if (!has_open_light_budget(settings.integrator)) return std::nullopt;
  const Clock::time_point start = Clock::now();
  const std::int64_t facets = facet_count(scene.lights);
  const LightBudget usual = light_budget(settled(settings.integrator, scene.lights));
  BudgetPilot pilot{usual, {{usual, 0, 0}}};
  for (const int light_samples : {1, 4})
    for (const int candidates : {1, usual.candidates})
      if (const LightBudget other{light_samples, candidates};
          std::ranges::none_of(pilot.tried, [&](const TriedBudget& known) { return known.budget == other; }))
        pilot.tried.push_back({other, 0, 0});
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  if (pixels < fewest_pixels_for_pilots) return std::nullopt;
  PilotSquares squares(scene, settings,
                       int(std::min(pixels / pixels_a_budget_square, double(most_budget_squares))));
  RenderSettings of_pilot = pilot_settings(settings, 0xb0d9e7);
  for (TriedBudget& each : pilot.tried) {
    of_pilot.integrator = with_light_budget(settings.integrator, each.budget);
    const std::optional<double> error = error_of(squares, of_pilot, stop);
    if (!error) return std::nullopt;
    each.error = *error;
    each.seconds = seconds_of_sample(scene, facets, each.budget);
  }
  const auto best = std::ranges::max_element(pilot.tried, {}, &TriedBudget::efficiency);
  if (best->efficiency() > better_by * pilot.tried.front().efficiency()) pilot.chosen = best->budget;
  pilot.seconds = seconds_since(start);
  return pilot;
}

}  // namespace etendue

#include "render/light_budget.h"

#include "base/clock.h"
#include "render/pilot_squares.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue {
namespace {

constexpr int samples_of_budget = 8;  // A pixel, in each of the two renders.
// That a change has to gain; more paths less, as with the pilot's few samples a pixel they gain less.
constexpr double better_by = 1.15, better_by_paths = 1.05;
constexpr int pixels_a_budget_square = 1024, most_budget_squares = 2048;

constexpr std::int64_t swarm = 1 << 16;  // Facets from which on the light tree waits for memory.

/// About how long a sample takes, in seconds. Fitted to renders of eight scenes of 1e1 to 2e4 triangles with
/// some ten budgets each, whose ratios it gives within 9 % (one standard deviation).
double seconds_of_sample(const Scene& scene, const RenderCounts& counts, std::int64_t facets) {
  const auto log2_of = [](std::int64_t count) { return std::log2(double(std::max<std::int64_t>(count, 1))); };
  const double ray = 30e-9 + 4e-9 * log2_of(scene.geometry.triangle_count()),
               candidate = facets < swarm ? 50e-9 : 130e-9,
               vertex = 10e-9 * log2_of(facets);  // Its light sample walks down the light tree.
  const double seconds = ray * (0.7 * double(counts.camera_rays + counts.outline_rays) +
                                0.2 * double(counts.shadow_rays) + 2.2 * double(counts.bsdf_rays)) +
                         vertex * double(counts.bsdf_rays) + candidate * double(counts.candidates);
  return seconds / double(counts.samples);
}

/// What a sample has of the cut of its tile, about, where a pixel takes 16.
double seconds_of_cut(std::int64_t facets) {
  if (facets <= 1) return 0;
  const double clusters = double(std::min<std::int64_t>(facets, LightCut::most_clusters));
  const double cut = (30e-6 + 1e-6 * clusters) * (facets < swarm ? 1 : 16);
  return cut / (16 * LightCut::tile_px * LightCut::tile_px);
}

double squared(double x) { return x * x; }

struct Means {
  double plain, of_squares;
};

/// Of values beyond `most` taken for it.
Means means_of(const std::vector<double>& values, double most) {
  double sum = 0, sum_of_squares = 0;
  for (const double value : values) {
    sum += std::min(value, most);
    sum_of_squares += squared(std::min(value, most));
  }
  return {sum / double(values.size()), sum_of_squares / double(values.size())};
}

bool have_glossy(const Scene& scene) {
  for (std::int32_t id = 0; id < scene.materials.count(); ++id)
    if (!scene.materials.is_diffuse<float>(id)) return true;
  return scene.medium.has_value();
}

/// Tries one budget after the other, and knows the best.
class Trials {
 public:
  Trials(const Scene& scene, const RenderSettings& settings, const StopRequest* stop)
      : scene_(scene),
        settings_(settings),
        stop_(stop),
        facets_(settings.integrator.light_sampler() == "tree" ? facet_count(scene.lights) : 1),
        squares_(scene, settings, square_count(scene)) {}

  /// False where it was stopped.
  bool start_with(const LightBudget& usual) { return render(usual); }

  const LightBudget& best() const { return tried_[best_].budget; }

  /// The one of `budgets` that gains most becomes the best if that is `least` or more; each after the first
  /// is tried only where the one before gains at all. False where it was stopped.
  bool consider(std::initializer_list<LightBudget> budgets, double least = better_by) {
    const std::size_t before = best_;
    double most = least;
    for (const LightBudget& budget : budgets) {
      if (budget == tried_[before].budget) continue;
      if (!render(budget)) return false;
      const double gain = tried_.back().gain_over(tried_[before]);
      if (gain >= most) best_ = tried_.size() - 1, most = gain;
      if (!(gain > 1)) break;
    }
    return true;
  }

  BudgetPilot result() && { return {best(), std::move(tried_), 0}; }

 private:
  static int square_count(const Scene& scene) {
    const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
    return int(std::min(pixels / pixels_a_budget_square, double(most_budget_squares)));
  }

  bool render(const LightBudget& budget) {
    RenderSettings of_pilot = pilot_settings(settings_, 0xb0d9e7);
    of_pilot.integrator = with_light_budget(settings_.integrator, budget);
    const auto rendering = squares_.render(of_pilot, 2, samples_of_budget, stop_);
    if (!rendering) return false;
    TriedBudget tried{
        budget, {}, seconds_of_sample(scene_, rendering->counts, facets_) + seconds_of_cut(facets_)};
    const std::vector<Color<double>>& means = rendering->means;
    for (std::size_t i = 0; i < means.size(); i += 2)
      tried.differences.push_back(std::abs(luminance(means[i]) - luminance(means[i + 1])));
    tried_.push_back(std::move(tried));
    return true;
  }

  const Scene& scene_;
  const RenderSettings& settings_;
  const StopRequest* stop_;
  const std::int64_t facets_;  ///< That a light tree chooses among.
  PilotSquares squares_;
  std::vector<TriedBudget> tried_;
  std::size_t best_ = 0;
};

}  // namespace

double TriedBudget::error() const {
  double sum = 0;
  for (const double difference : differences) sum += difference;
  return sum / double(differences.size());
}

double TriedBudget::gain_over(const TriedBudget& other) const {
  constexpr double share_of_largest = 0.02;
  std::vector<double> larger;
  for (std::size_t i = 0; i < differences.size(); ++i)
    larger.push_back(std::max(differences[i], other.differences[i]));
  const auto most = larger.begin() + std::ptrdiff_t((1 - share_of_largest) * double(larger.size()));
  std::ranges::nth_element(larger, most);
  if (!(*most > 0)) return 1;  // Hardly any pixel has noise: nothing to choose by.
  const Means these = means_of(differences, *most), others = means_of(other.differences, *most);
  const double by_error = squared(others.plain / these.plain),
               by_square = others.of_squares / these.of_squares;
  return std::min(by_error, by_square) * other.seconds / seconds;
}

double BudgetPilot::gain() const {
  return std::ranges::find(tried, chosen, &TriedBudget::budget)->gain_over(tried.front());
}

std::optional<BudgetPilot> light_budget_for(const Scene& scene, const RenderSettings& settings,
                                            const StopRequest* stop) {
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  if (!has_open_light_budget(settings.integrator) || pixels < fewest_pixels_for_pilots) return std::nullopt;
  const Clock::time_point start = Clock::now();
  const LightBudget usual = light_budget(settled(settings.integrator, scene.lights));
  Trials trials(scene, settings, stop);
  const auto with = [&](int LightBudget::*number, int value) {
    LightBudget changed = trials.best();
    changed.*number = value;
    return changed;
  };
  constexpr int many_candidates = 16, several_samples = 4;
  const bool is_whole =
      trials.start_with(usual) &&
      (!have_glossy(scene) || usual.glossy_candidates >= many_candidates ||
       trials.consider({with(&LightBudget::glossy_candidates, many_candidates)})) &&
      trials.consider({with(&LightBudget::light_samples, usual.light_samples == 1 ? several_samples : 1)}) &&
      trials.consider({with(&LightBudget::candidates, 1)}) &&
      (settings.integrator.path_rules()->length() == PathLength::one_vertex ||
       trials.consider({with(&LightBudget::bsdf_samples, 2), with(&LightBudget::bsdf_samples, 4),
                        with(&LightBudget::bsdf_samples, 8)},
                       better_by_paths));
  if (!is_whole) return std::nullopt;
  BudgetPilot pilot = std::move(trials).result();
  pilot.seconds = seconds_since(start);
  return pilot;
}

}  // namespace etendue

#include "verify/verify.h"

#include "base/hash.h"
#include "lint/probe.h"
#include "render/image_layers.h"
#include "stats/significance.h"
#include "verify/film_cells.h"
#include "verify/pilot_noise.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <tbb/parallel_for.h>

namespace etendue {
namespace {

constexpr int most_replicates = 32, least_replicates = 8;

/// The brightest that a ray can meet, luminance: what a sample that meets a light by chance adds at most.
double brightest_light(const Scene& scene) {
  constexpr int tries = 256;
  ProbeNumbers numbers(1);
  const Receiver<float> receiver{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, lit_side::medium};
  double brightest = 0;
  const auto take = [&](const Colorf& radiance) {
    const double l = luminance(radiance);
    if (std::isfinite(l)) brightest = std::max(brightest, l);
  };
  const int infinite = scene.lights.infinite_count();
  for (int k = 0; k < infinite; ++k)
    for (int i = 0; i < tries; ++i) {
      const LightSample<float> sample =
          scene.lights.sample<float>(scene.lights.infinite_light(k), 1, receiver, numbers.two_bits(), true);
      if (sample.is_there) take(sample.radiance_over_pdf * sample.pdf_solid_angle);
    }
  for (const std::int32_t light : scene.geometry.light)
    if (light >= 0) take(scene.lights.largest_radiance(light));
  return brightest;
}

/// The most of a light's radiance that a BSDF sample takes on from a diffuse surface.
double largest_diffuse_weight(const Scene& scene) {
  const auto weight_of = [](const auto& material) -> double {
    if (!material.is_diffuse()) return 0;
    if (material.has_texture()) return 1;
    const Colorf weight =
        material.at(Vec2<float>{0, 0}, true).sample(Vec3<float>{0, 0, 1}, Vec2<float>{0.5f, 0.5f}).weight;
    return std::max({weight.r, weight.g, weight.b});
  };
  double largest = 0;
  for (std::int32_t m = 0; m < scene.materials.count(); ++m)
    largest = std::max(largest, std::visit(weight_of, scene.materials[m]));
  return largest;
}

/// Replicates that memory allows to be kept.
int replicate_count(const Scene& scene, double samples_per_pixel) {
  const double pixels = double(scene.camera.width_px) * scene.camera.height_px;
  const double kept = double(ReplicateLuminances::most_bytes) / sizeof(float) / pixels;
  return int(std::clamp(std::floor(std::min(samples_per_pixel, kept)), double(least_replicates),
                        double(most_replicates)));
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

RenderSettings settings_of(const VerifySettings& asked, const Estimator& estimator, std::size_t number) {
  RenderSettings settings;
  settings.integrator = estimator.integrator;
  settings.replicates_by = ReplicatesBy::scrambling;
  settings.seed = hash64(hash64(asked.seed) + number);
  settings.threads = asked.threads;
  settings.isa = asked.isa;
  if (!asked.against) {
    settings.layers.push_back(scattered_light());
    settings.keeps_luminances_of_layer = true;
  }
  return settings;
}

/// Black, without noise, where the other renderer's image cannot be read: there all agree.
void leave_out_unreadable(const ForeignImage* foreign, MomentImage& image) {
  if (!foreign) return;
  for (std::size_t k = 0; k < image.pixels.size(); ++k)
    if (!foreign->is_readable[k]) image.pixels[k] = {};
}

/// Of path integrators all that is seen may have rare hits, as glossy surfaces send light to the others.
FilmCells film_of(const Scene& scene, const Estimators& estimators) {
  const bool is_direct = estimators.all.front().integrator.path_rules()->length() == PathLength::one_vertex;
  std::vector<char> has_rare_hits;
  for (std::int32_t m = 0; m < scene.materials.count(); ++m)
    has_rare_hits.push_back(!scene.materials.is_diffuse<float>(m));
  if (!is_direct && std::ranges::find(has_rare_hits, 1) != has_rare_hits.end())
    std::ranges::fill(has_rare_hits, 1);
  const int width = scene.camera.width_px, height = scene.camera.height_px,
            margin_px = int(std::ceil(scene.filter.radius_px())) + 1;
  return film_cells(width, height, materials_seen(scene), std::move(has_rare_hits), margin_px);
}

/// Renders the estimators one after the other.
class Runs {
 public:
  Runs(const Scene& scene, const Estimators& estimators, const VerifySettings& settings,
       const VerifyProgress& progress, const StopRequest* stop)
      : film(film_of(scene, estimators)),
        scene_(scene),
        estimators_(estimators.all),
        settings_(settings),
        progress_(progress),
        stop_(stop),
        brightest_(brightest_light(scene)),
        largest_diffuse_weight_(largest_diffuse_weight(scene)),
        start_s_(now_s()) {}

  const FilmCells film;

  /// First of all. Nothing where it was interrupted.
  bool render_pilots() {
    for (std::size_t number = 0; number < estimators_.size(); ++number) {
      PilotNoise pilot = pilot_of(number);
      if (stop_ && stop_->soon) return false;
      pilots_.push_back(std::move(pilot));
    }
    cell_means_ = median_means(pilots_);
    for (PilotNoise& pilot : pilots_)
      set_relative_variances(pilot, film, blocks_along(scene_.camera.width_px), cell_means_);
    shares_ = shares_of_time(pilots_, film, settings_.seconds);
    return true;
  }

  /// Nothing where it was interrupted.
  std::optional<VerifiedEstimator> render(std::size_t number) const {
    const Estimator& estimator = estimators_[number];
    RenderSettings settings = settings_of(settings_, estimator, number);
    const double samples =
        settings_.samples_per_pixel ? double(*settings_.samples_per_pixel) : samples_in_time(number);
    const int replicates = replicate_count(scene_, samples);
    const double of_replicate = samples / replicates;
    settings.replicates = replicates;
    settings.samples_per_pixel =
        replicates *
        int(std::max(1.0, settings_.samples_per_pixel ? std::ceil(of_replicate) : std::floor(of_replicate)));
    const RenderResult rendered = etendue::render(
        scene_, settings, [&](const RenderProgress& p) { report(number, p.fraction); }, stop_);
    if (rendered.is_interrupted) return std::nullopt;
    VerifiedEstimator verified = verified_image(estimator, moment_image(rendered));
    verified.samples_per_pixel = settings.samples_per_pixel;
    verified.replicates = replicates;
    verified.seconds = rendered.seconds;
    verified.invalid_samples = rendered.invalid.count();
    return verified;
  }

  VerifiedEstimator verified_image(const Estimator& estimator, MomentImage image) const {
    leave_out_unreadable(settings_.against, image);
    VerifiedEstimator verified{.estimator = estimator, .image = compared_image(std::move(image), film)};
    const MeanMoments mean = verified.image.whole.scaled(1 / double(verified.image.image.pixels.size()));
    verified.mean = mean.mean;
    verified.standard_error = mean.standard_error();
    return verified;
  }

  /// What rare events may add. A sample that meets a light by chance adds at most the brightest one. Light
  /// samples may have met nothing of a light on the horizon, or of a lobe that reflects one, and then do not
  /// tell how much a hit adds: what other estimators have met does. Where both techniques are weighed there
  /// are no such hits of a lobe.
  void raise_steps_of_rare_events(std::vector<VerifiedEstimator>& estimators) const {
    LeastSteps met;  // Of one light sample.
    for (const VerifiedEstimator& each : estimators) {
      if (!each.estimator.integrator.path_rules()->light_samples()) continue;
      const LeastSteps seen = steps_seen(each.image, film);
      met.of_lobes = std::max(met.of_lobes, seen.of_lobes * each.samples_per_pixel);
      met.of_others = std::max(met.of_others, seen.of_others * each.samples_per_pixel);
    }
    const double by_chance = brightest_ * largest_diffuse_weight_;
    for (VerifiedEstimator& each : estimators) {
      const PathRules& rules = *each.estimator.integrator.path_rules();
      LeastSteps least = met;
      if (!rules.light_samples())
        least = {brightest_, by_chance};
      else if (rules.needs_both_pdfs())  // No sample adds more than one that meets the light by chance.
        least = {0, std::min(met.of_others, by_chance)};
      else if (rules.light_samples()->technique != LightTechnique::area)  // Density at least 1 / (2 pi).
        least.of_others = std::min(met.of_others, 2 * scene_.lights.count() * by_chance);
      const double samples = each.samples_per_pixel;
      raise_steps(each.image, film, {least.of_lobes / samples, least.of_others / samples});
    }
  }

  const std::vector<double>& cell_means() const { return cell_means_; }

  /// For the comparison of two estimators; that after the last is another renderer's image, whose noise is
  /// known from elsewhere.
  std::vector<double> weights(const std::vector<VerifiedEstimator>& estimators, std::size_t a,
                              std::size_t b) const {
    const std::vector<double> none(film.cells.size(), 0.0);
    const auto of = [&](std::size_t k) -> const std::vector<double>& {
      return estimators[k].is_foreign ? none : pilots_[k].relative_variance;
    };
    const auto samples = [&](std::size_t k) { return std::max(1, estimators[k].samples_per_pixel); };
    return cell_weights(film, cell_means_, of(a), samples(a), of(b), samples(b));
  }

  double seconds_per_sample(std::size_t number) const { return pilots_[number].seconds_per_sample; }
  double seconds_left() const { return settings_.seconds - (now_s() - start_s_); }

 private:
  /// Of as many samples as a hundredth of the time allows, within reason.
  PilotNoise pilot_of(std::size_t number) const {
    constexpr int replicates = 4, most_samples = 256;
    constexpr double share = 0.01;
    RenderSettings settings = settings_of(settings_, estimators_[number], number);
    settings.seed = hash64(settings.seed);
    settings.replicates = replicates;
    const int most = settings_.samples_per_pixel ? *settings_.samples_per_pixel / 8 : most_samples;
    for (int samples = replicates;; samples *= 4) {
      settings.samples_per_pixel = samples;
      const RenderResult rendered = etendue::render(scene_, settings, {}, stop_);
      const bool is_last = samples * 4 > most || rendered.seconds * 4 > share * settings_.seconds;
      if (rendered.is_interrupted) return {};
      if (is_last)
        return {.seconds_per_sample = std::max(rendered.seconds / samples, 1e-9),
                .cells = film.sums(moment_image(rendered)),
                .samples_per_pixel = samples};
    }
  }

  /// What its share of the time that is left allows.
  double samples_in_time(std::size_t number) const {
    constexpr double reserve = 0.1;  // For comparing, and for looking at lights.
    const double of_those_left =
        shares_[number] / std::accumulate(shares_.begin() + std::ptrdiff_t(number), shares_.end(), 0.0);
    const double left = seconds_left() - reserve * settings_.seconds;
    return std::min(left * of_those_left / pilots_[number].seconds_per_sample, 1e6);
  }

  void report(std::size_t number, double fraction) const {
    if (progress_) progress_((double(number) + fraction) / double(estimators_.size()));
  }

  const Scene& scene_;
  const std::vector<Estimator>& estimators_;
  const VerifySettings& settings_;
  const VerifyProgress& progress_;
  const StopRequest* stop_;
  double brightest_, largest_diffuse_weight_, start_s_;
  std::vector<PilotNoise> pilots_;
  std::vector<double> cell_means_, shares_;
};

std::vector<VerifiedPair> compare_all(const Runs& runs, const std::vector<VerifiedEstimator>& estimators,
                                      double level) {
  std::vector<VerifiedPair> pairs;
  for (std::size_t a = 0; a < estimators.size(); ++a)
    for (std::size_t b = a + 1; b < estimators.size(); ++b) pairs.push_back({a, b, {}});
  const double level_of_pair = level / double(std::max<std::size_t>(1, pairs.size()));
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t k) {
    const auto [a, b] = std::pair(pairs[k].a, pairs[k].b);
    pairs[k].comparison = compare(estimators[a].image, estimators[b].image, runs.film, runs.cell_means(),
                                  runs.weights(estimators, a, b), level_of_pair);
  });
  std::vector<double> p_values;
  for (const VerifiedPair& pair : pairs) p_values.push_back(pair.comparison.p_value);
  const std::vector<double> adjusted = holm_adjusted(p_values);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k].p_value = adjusted[k];
    pairs[k].verdict = adjusted[k] < level              ? Verdict::differ
                       : pairs[k].comparison.can_tell() ? Verdict::agree
                                                        : Verdict::cannot_tell;
  }
  return pairs;
}

/// Takes the estimator that differs from most others out, until those left agree; where it is one against
/// one, neither can be told to be odd.
void find_odd(VerifyResult& result) {
  std::vector<VerifiedEstimator>& estimators = result.estimators;
  for (;;) {
    std::vector<std::size_t> differing(estimators.size(), 0);
    for (const VerifiedPair& pair : result.pairs)
      if (pair.verdict == Verdict::differ && !estimators[pair.a].is_odd && !estimators[pair.b].is_odd)
        ++differing[pair.a], ++differing[pair.b];
    const auto most = std::max_element(differing.begin(), differing.end());
    if (most == differing.end() || *most == 0) return;
    if (std::count(differing.begin(), differing.end(), *most) > 1 && estimators.size() == 2) return;
    estimators[std::size_t(most - differing.begin())].is_odd = true;
  }
}

/// Of our own.
const VerifiedEstimator& most_precise(const std::vector<VerifiedEstimator>& estimators) {
  return *std::min_element(estimators.begin(), estimators.end(), [](const auto& a, const auto& b) {
    return std::pair(a.is_foreign, a.standard_error) < std::pair(b.is_foreign, b.standard_error);
  });
}

/// The other renderer's image as one more estimator, its noise estimated where that is not known.
void add_foreign(const Runs& runs, const VerifySettings& settings, VerifyResult& result) {
  ForeignImage foreign = *settings.against;
  if (foreign.noise.empty()) estimate_noise(foreign, most_precise(result.estimators).image.image);
  result.foreign_noise = foreign.noise;
  result.foreign_hint = foreign.hint;
  result.foreign_pixels_left_out = std::ranges::count(foreign.is_readable, 0);
  result.estimators.push_back(runs.verified_image({settings.against_name, {}}, foreign.image));
  result.estimators.back().is_foreign = true;
}

/// The pair in which an estimator differs most; null where it differs in none.
VerifiedPair* strongest_pair_of(VerifyResult& result, std::size_t estimator) {
  VerifiedPair* strongest = nullptr;
  for (VerifiedPair& pair : result.pairs)
    if (pair.verdict == Verdict::differ && (pair.a == estimator || pair.b == estimator) &&
        !result.estimators[pair.a].is_foreign && !result.estimators[pair.b].is_foreign &&
        (!strongest || pair.comparison.p_value < strongest->comparison.p_value))
      strongest = &pair;
  return strongest;
}

/// Looks for the lights by which the odd estimators differ; of a few of them, as it takes two renders each,
/// and in the time that is left.
void find_lights(const Scene& scene, const Runs& runs, const VerifySettings& settings, VerifyResult& result,
                 const StopRequest* stop) {
  constexpr int most_looked_at = 3, replicates = 8, most_samples = 64;
  constexpr double layers_cost = 2;  // Times a render without.
  int looked_at = 0;
  for (std::size_t k = 0; k < result.estimators.size() && looked_at < most_looked_at; ++k) {
    VerifiedPair* const pair = strongest_pair_of(result, k);
    const bool has_odd = pair && (result.estimators[pair->a].is_odd || result.estimators[pair->b].is_odd);
    if (!pair || !pair->lights.empty() || (has_odd && !result.estimators[k].is_odd)) continue;
    ++looked_at;
    if (scene.lights.count() == 1) {
      pair->lights.push_back({0, pair->comparison.ratio, pair->p_value});
      continue;
    }
    const double of_one = layers_cost * (runs.seconds_per_sample(pair->a) + runs.seconds_per_sample(pair->b)),
                 in_time = settings.samples_per_pixel
                               ? std::min(result.estimators[pair->a].samples_per_pixel,
                                          result.estimators[pair->b].samples_per_pixel) /
                                     2.0
                               : runs.seconds_left() / of_one;
    const int samples = int(std::min<double>(in_time, most_samples)) / replicates * replicates;
    if (samples == 0 && !settings.samples_per_pixel) continue;
    const auto again = [&](std::size_t number) {
      RenderSettings render = settings_of(settings, result.estimators[number].estimator, number);
      render.seed = hash64(render.seed + 1);
      render.replicates = replicates;
      render.samples_per_pixel = std::max(samples, replicates);
      return render;
    };
    pair->lights = light_differences(scene, again(pair->a), again(pair->b), settings.level, stop);
  }
}

}  // namespace

VerifyResult verify(const Scene& scene, const Estimators& estimators, const VerifySettings& settings,
                    const VerifyProgress& progress, const StopRequest* stop) {
  VerifyResult result{
      .estimators = {}, .left_out = estimators.left_out, .pairs = {}, .level = settings.level};
  Runs runs(scene, estimators, settings, progress, stop);
  result.is_interrupted = !runs.render_pilots();
  for (std::size_t k = 0; k < estimators.all.size() && !result.is_interrupted; ++k) {
    std::optional<VerifiedEstimator> verified = runs.render(k);
    if (verified)
      result.estimators.push_back(std::move(*verified));
    else
      result.is_interrupted = true;
  }
  runs.raise_steps_of_rare_events(result.estimators);
  if (settings.against && !result.estimators.empty()) add_foreign(runs, settings, result);
  result.pairs = compare_all(runs, result.estimators, settings.level);
  find_odd(result);
  bool differs = false, tells = false;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  result.smallest_difference = infinity;
  for (VerifiedEstimator& estimator : result.estimators) estimator.smallest_difference = infinity;
  for (const VerifiedPair& pair : result.pairs) {
    differs = differs || pair.verdict == Verdict::differ;
    tells = tells || pair.verdict != Verdict::cannot_tell;
    for (const std::size_t k : {pair.a, pair.b}) {
      VerifiedEstimator& estimator = result.estimators[k];
      estimator.can_tell = estimator.can_tell || pair.verdict != Verdict::cannot_tell;
      estimator.smallest_difference =
          std::min(estimator.smallest_difference, pair.comparison.smallest_difference);
    }
    result.smallest_difference = std::min(result.smallest_difference, pair.comparison.smallest_difference);
  }
  result.verdict = differs ? Verdict::differ : tells ? Verdict::agree : Verdict::cannot_tell;
  if (differs && !result.is_interrupted) find_lights(scene, runs, settings, result, stop);
  if (differs && settings.against && result.estimators.back().is_foreign)
    result.mishap = likely_mishap(*settings.against, most_precise(result.estimators).image.image);
  return result;
}

}  // namespace etendue

#include "verify/verify.h"

#include "base/hash.h"
#include "integrator/single_sample.h"
#include "lint/probe.h"
#include "stats/significance.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
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

/// Renders the estimators one after the other.
class Runs {
 public:
  Runs(const Scene& scene, const Estimators& estimators, const VerifySettings& settings,
       const VerifyProgress& progress, const StopRequest* stop)
      : scene_(scene),
        estimators_(estimators.all),
        settings_(settings),
        progress_(progress),
        stop_(stop),
        materials_(materials_seen(scene)),
        brightest_(brightest_light(scene)),
        start_s_(now_s()) {}

  /// Nothing where it was interrupted.
  std::optional<VerifiedEstimator> render(std::size_t number) {
    const Estimator& estimator = estimators_[number];
    RenderSettings settings = settings_of(settings_, estimator, number);
    const double samples = settings_.samples_per_pixel
                               ? double(*settings_.samples_per_pixel)
                               : samples_in_time(settings, estimators_.size() - number);
    if (stop_ && stop_->soon) return std::nullopt;
    const int replicates = replicate_count(scene_, samples);
    const double of_replicate = samples / replicates;
    settings.replicates = replicates;
    settings.samples_per_pixel =
        replicates *
        int(std::max(1.0, settings_.samples_per_pixel ? std::ceil(of_replicate) : std::floor(of_replicate)));
    const RenderResult rendered = etendue::render(
        scene_, settings, [&](const RenderProgress& p) { report(number, p.fraction); }, stop_);
    if (rendered.is_interrupted) return std::nullopt;
    VerifiedEstimator verified = verified_image(estimator, moment_image(rendered), unseen_step(settings));
    verified.samples_per_pixel = settings.samples_per_pixel;
    verified.replicates = replicates;
    verified.seconds = rendered.seconds;
    verified.invalid_samples = rendered.invalid.count();
    return verified;
  }

  VerifiedEstimator verified_image(const Estimator& estimator, MomentImage image, double unseen_step) const {
    leave_out_unreadable(settings_.against, image);
    VerifiedEstimator verified{
        .estimator = estimator,
        .image = compared_image(std::move(image), materials_, scene_.materials.count(), unseen_step)};
    const MeanMoments mean = verified.image.whole.scaled(1 / double(verified.image.image.pixels.size()));
    verified.mean = mean.mean;
    verified.standard_error = mean.standard_error();
    return verified;
  }

 private:
  /// What an even share of the time that is left allows, from a pilot of one sample.
  double samples_in_time(RenderSettings settings, std::size_t estimators_left) const {
    constexpr double reserve = 0.85;  // For comparing, and for looking at lights.
    settings.samples_per_pixel = 1;
    settings.seed = hash64(settings.seed);
    const double seconds = etendue::render(scene_, settings, {}, stop_).seconds;
    const double left = reserve * settings_.seconds - (now_s() - start_s_);
    return std::min(left / double(estimators_left) / std::max(seconds, 1e-6), 1e6);
  }

  double unseen_step(const RenderSettings& settings) const {
    return settings.integrator.path_rules()->light_samples() ? 0 : brightest_ / settings.samples_per_pixel;
  }

  void report(std::size_t number, double fraction) const {
    if (progress_) progress_((double(number) + fraction) / double(estimators_.size()));
  }

  const Scene& scene_;
  const std::vector<Estimator>& estimators_;
  const VerifySettings& settings_;
  const VerifyProgress& progress_;
  const StopRequest* stop_;
  std::vector<std::int32_t> materials_;
  double brightest_, start_s_;
};

/// Of a lobe that reflects a light, light samples may have met nothing, and then do not tell how much a hit
/// adds: what another estimator has met does. Where both techniques are weighed there are no such hits.
void share_steps(std::vector<VerifiedEstimator>& estimators) {
  double step = 0;  // Of one sample.
  for (const VerifiedEstimator& each : estimators)
    if (each.estimator.integrator.path_rules()->light_samples())
      step = std::max(step, each.image.whole.step() * each.samples_per_pixel);
  for (VerifiedEstimator& each : estimators) {
    const PathRules& rules = *each.estimator.integrator.path_rules();
    if (rules.light_samples() && !rules.needs_both_pdfs())
      set_unseen_step(each.image, step / each.samples_per_pixel);
  }
}

std::vector<VerifiedPair> compare_all(const std::vector<VerifiedEstimator>& estimators, double level) {
  std::vector<VerifiedPair> pairs;
  for (std::size_t a = 0; a < estimators.size(); ++a)
    for (std::size_t b = a + 1; b < estimators.size(); ++b) pairs.push_back({a, b, {}});
  const double level_of_pair = level / double(std::max<std::size_t>(1, pairs.size()));
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t k) {
    pairs[k].comparison = compare(estimators[pairs[k].a].image, estimators[pairs[k].b].image, level_of_pair);
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

const VerifiedEstimator& most_precise(const std::vector<VerifiedEstimator>& estimators) {
  return *std::min_element(estimators.begin(), estimators.end(),
                           [](const auto& a, const auto& b) { return a.standard_error < b.standard_error; });
}

/// The other renderer's image as one more estimator, its noise estimated where that is not known.
void add_foreign(const Runs& runs, const VerifySettings& settings, VerifyResult& result) {
  ForeignImage foreign = *settings.against;
  if (foreign.noise.empty()) estimate_noise(foreign, most_precise(result.estimators).image.image);
  result.foreign_noise = foreign.noise;
  result.estimators.push_back(runs.verified_image({settings.against_name, {}}, foreign.image, 0));
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

/// Looks for the lights by which the odd estimators differ; of a few of them, as it takes two renders each.
void find_lights(const Scene& scene, const VerifySettings& settings, VerifyResult& result,
                 const StopRequest* stop) {
  constexpr int most_looked_at = 3, replicates = 16, most_samples = 64;
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
    const auto again = [&](std::size_t number) {
      RenderSettings render = settings_of(settings, result.estimators[number].estimator, number);
      render.seed = hash64(render.seed + 1);
      render.replicates = replicates;
      render.samples_per_pixel =
          std::clamp(result.estimators[number].samples_per_pixel / 2, replicates, most_samples) / replicates *
          replicates;
      return render;
    };
    pair->lights = light_differences(scene, again(pair->a), again(pair->b), settings.level, stop);
  }
}

}  // namespace

std::vector<std::int32_t> materials_seen(const Scene& scene) {
  const Camera& camera = scene.camera;
  std::vector<std::int32_t> seen(std::size_t(camera.width_px) * std::size_t(camera.height_px));
  tbb::parallel_for(0, camera.height_px, [&](int y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const CameraRay<float> ray = camera.ray(float(x) + 0.5f, float(y) + 0.5f);
      const Hit<float> hit = closest_hit(scene, {ray.origin, ray.direction}, ray.t_near, ray.t_far);
      seen[std::size_t(y) * std::size_t(camera.width_px) + std::size_t(x)] =
          hit.geometry < 0 ? -1 : scene.geometry.material[std::size_t(hit.geometry)];
    }
  });
  return seen;
}

VerifyResult verify(const Scene& scene, const Estimators& estimators, const VerifySettings& settings,
                    const VerifyProgress& progress, const StopRequest* stop) {
  VerifyResult result{
      .estimators = {}, .left_out = estimators.left_out, .pairs = {}, .level = settings.level};
  Runs runs(scene, estimators, settings, progress, stop);
  for (std::size_t k = 0; k < estimators.all.size() && !result.is_interrupted; ++k) {
    std::optional<VerifiedEstimator> verified = runs.render(k);
    if (verified)
      result.estimators.push_back(std::move(*verified));
    else
      result.is_interrupted = true;
  }
  share_steps(result.estimators);
  if (settings.against && !result.estimators.empty()) add_foreign(runs, settings, result);
  result.pairs = compare_all(result.estimators, settings.level);
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
  if (differs && !result.is_interrupted) find_lights(scene, settings, result, stop);
  if (differs && settings.against && result.estimators.back().is_foreign)
    result.mishap = likely_mishap(*settings.against, most_precise(result.estimators).image.image);
  return result;
}

}  // namespace etendue

#include "course/diagnosis.h"

#include "stats/chi_squared.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace etendue {

namespace {

using enum MistakeClass;

template <class T>
double sum_of_channels(const Color<T>& c) {
  return double(c.r) + double(c.g) + double(c.b);
}

/// How likely each light of a probe is to be chosen, if it is so by this.
std::vector<double> shares_by(const std::vector<double>& weights) {
  double sum = 0;
  for (const double one : weights) sum += one;
  std::vector<double> shares;
  for (const double one : weights) shares.push_back(one / sum);
  return shares;
}

using ByProbe = std::vector<std::vector<double>>;

double p_value_of_choice(const ProbeEvidence& evidence, const ByProbe& weights) {
  std::vector<double> observed, expected;
  for (std::size_t probe = 0; probe < weights.size(); ++probe) {
    double drawn = 0;
    for (const PointsOfLight& points : evidence.points[probe]) drawn += points.drawn;
    const std::vector<double> shares = shares_by(weights[probe]);
    if (shares.size() < 2 || drawn == 0) continue;
    for (std::size_t light = 0; light < shares.size(); ++light) {
      observed.push_back(evidence.points[probe][light].drawn);
      expected.push_back(shares[light] * drawn);
    }
  }
  return observed.size() < 2 ? 1 : chi_squared_test(observed, expected).p_value;
}

/// The samples, with the probability that each of their lights was chosen with: by power or by area where the
/// choices say so, else each light alike.
std::vector<SampleEvidence> with_choice(const ProbeEvidence& evidence) {
  ByProbe alike = evidence.areas;
  for (std::vector<double>& one : alike) std::ranges::fill(one, 1.0);
  const ByProbe* chosen_by = &alike;
  constexpr double hopeless = 1e-6;
  if (p_value_of_choice(evidence, alike) < hopeless)
    for (const ByProbe* other : {&evidence.powers, &evidence.areas})
      if (p_value_of_choice(evidence, *other) > hopeless) chosen_by = other;
  std::vector<SampleEvidence> samples = evidence.samples;
  for (SampleEvidence& sample : samples) {
    const std::vector<double> shares = shares_by((*chosen_by)[sample.probe]);
    for (LightPointFacts& point : sample.points)
      if (point.light >= 0) point.choice_probability = shares[std::size_t(point.light)];
  }
  return samples;
}

std::string percent(double share) {
  return fmt::format("{:.{}f} %", 100 * share, share > 0.0995 && share < 0.9995 ? 0 : 1);
}

/// Mean over expectation, of all rays to receivers of a probe.
std::string ratio_of_probe(const ProbeEvidence& evidence, std::size_t probe) {
  double mean = 0, expected = 0, error_sq = 0;
  for (const RayEvidence& ray : evidence.rays) {
    if (ray.probe != probe || ray.is_light) continue;
    expected += sum_of_channels(ray.expected);
    for (const RunningStatistics& channel : ray.channels) {
      mean += channel.mean;
      error_sq += channel.count > 1 ? channel.variance() / double(channel.count) : 0;
    }
  }
  return fmt::format("{:.4f} +- {:.4f}", mean / expected, std::sqrt(error_sq) / expected);
}

/// What is seen of the light where nothing hides it, with one light and with several.
std::string ratios(const ProbeEvidence& evidence) {
  std::string text;
  for (std::size_t probe = 0; probe < evidence.areas.size() && probe < 3; ++probe) {
    const std::size_t lights = evidence.areas[probe].size();
    text += fmt::format("{}{} with {} light{}", text.empty() ? "" : ", ", ratio_of_probe(evidence, probe),
                        lights, lights == 1 ? "" : "s");
  }
  return "of the right light come " + text;
}

std::string text_of_factor(double factor) {
  struct Known {
    double value;
    const char* name;
  };
  constexpr double pi_d = 3.14159265358979;
  for (const Known& known : {Known{pi_d, "pi"},
                             {1 / pi_d, "1/pi"},
                             {2.0, "2"},
                             {0.5, "1/2"},
                             {2 * pi_d, "2 pi"},
                             {4 * pi_d, "4 pi"},
                             {0.5 / pi_d, "1/(2 pi)"},
                             {pi_d * pi_d, "pi^2"},
                             {-1.0, "-1"},
                             {4.0, "4"},
                             {0.25, "1/4"}})
    if (std::abs(factor / known.value - 1) < 3e-3) return fmt::format("by {} ({:.4f})", known.name, factor);
  return fmt::format("by {:.4f}", factor);
}

std::string text_of_fit(const TermFit& fit) {
  std::string text;
  for (const TermMistake* one : fit.mistakes)
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", text_of(one->mistake).what, one->how);
  if (fit.factor != 1)
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", text_of(constant_factor).what,
                        text_of_factor(fit.factor));
  return text.empty() ? "no mistake in a single sample" : text;
}

std::string text_of_shadow_rays(const ProbeEvidence& e) {
  std::string text;
  const auto add = [&](std::int64_t count, std::int64_t of, const char* what) {
    if (count > 0) text += fmt::format("{} of {} {}; ", count, of, what);
  };
  add(e.ended_on_light, e.rays_to_visible, "rays to points that are seen end on the light itself");
  add(e.ended_on_receiver, e.rays_to_visible,
      "rays to points that are seen end on the surface that they start from");
  add(e.ended_elsewhere, e.rays_to_visible, "rays to points that are seen end on something else");
  if (e.rays_to_hidden > 0)
    text += fmt::format("{} rays to points that are hidden meet nothing, or the light; ", e.rays_to_hidden);
  return text;
}

class Diagnosing {
 public:
  explicit Diagnosing(const ProbeEvidence& evidence)
      : evidence_(evidence), samples_(with_choice(evidence)), fits_(fit_terms(evidence, samples_)) {}

  Diagnosis of(bool is_wrong) {
    result_.samples_compared = fits_.samples;
    result_.samples_wrong = fits_.wrong;
    if (!is_wrong) return result_;
    find_in_terms();
    find_in_choices();
    find_shared_numbers();
    find_in_values();
    find_in_emission();
    if (result_.findings.empty()) result_.is_unknown = true;
    return result_;
  }

 private:
  void add(MistakeClass mistake, std::string how, std::string evidence) {
    for (const FoundMistake& finding : result_.findings)
      if (finding.mistake == mistake) return;
    result_.findings.push_back({mistake, std::move(how), std::move(evidence)});
  }

  double share_explained(const TermFit& fit) const {
    return fits_.wrong > 0 ? std::max(0.0, 1 - double(fit.misses) / double(fits_.wrong)) : 0;
  }

  /// Of the best fit of this class by itself: of two mistakes, that which shows in more samples comes first.
  std::int64_t misses_alone(const TermMistake& mistake) const {
    for (const TermFit& fit : fits_.best)
      if (fit.is_of_one_class() && !fit.mistakes.empty() && fit.mistakes[0]->mistake == mistake.mistake)
        return fit.misses;
    return fits_.wrong;
  }

  bool is_all_black() const {
    return std::ranges::all_of(evidence_.samples, [](const SampleEvidence& sample) {
      return sample.value == Colorf{0, 0, 0};
    });
  }

  void find_in_terms() {
    constexpr double tiny = 2e-3, enough = 0.9, worth_telling = 0.1;
    const bool is_black = is_all_black();
    if (double(fits_.wrong) <= tiny * double(fits_.samples) && fits_.samples > 0) return;
    if (fits_.best.empty() || fits_.samples == 0) {
      if (is_black) add(nothing_returned, "", "every sample is 0");
      return;
    }
    const TermFit& best = fits_.best.front();
    result_.share_explained = share_explained(best);
    for (std::size_t i = 1; i < fits_.best.size(); ++i)
      if ((fits_.best[i].is_of_one_class() || !best.is_of_one_class()) &&
          share_explained(fits_.best[i]) >= worth_telling) {
        result_.runner_up = text_of_fit(fits_.best[i]);
        result_.share_runner_up = share_explained(fits_.best[i]);
        break;
      }
    if (result_.share_explained < enough) {
      if (is_black)
        add(nothing_returned, "", "every sample is 0");
      else
        result_.is_unknown = true;
      return;
    }
    if (is_black && !explains_black(best)) {
      add(nothing_returned, "", "every sample is 0");
      return;
    }
    result_.fit = best;
    std::ranges::stable_sort(result_.fit.mistakes, {},
                             [&](const TermMistake* one) { return misses_alone(*one); });
    for (const TermMistake* one : result_.fit.mistakes) {
      std::string evidence = fmt::format("{} of {} wrong samples come out so, up to rounding; {}",
                                         percent(result_.share_explained), fits_.wrong, ratios(evidence_));
      if (one->mistake == visibility_term) evidence = text_of_shadow_rays(evidence_) + evidence;
      add(one->mistake, std::string(one->how), evidence);
    }
    // Where the BSDF is sampled too, the factor may be what one of two techniques counts for.
    if (best.factor != 1 && evidence_.bsdf_samples == 0) {
      const bool is_sign = std::abs(best.factor + 1) < 3e-3;
      add(is_sign ? light_cosine_sign : constant_factor, text_of_factor(best.factor),
          fmt::format("{} of {} wrong samples come out so; {}", percent(result_.share_explained), fits_.wrong,
                      ratios(evidence_)));
    }
  }

  /// Black samples fit where shadow rays are what made them so.
  bool explains_black(const TermFit& fit) const {
    return std::ranges::any_of(fit.mistakes,
                               [](const TermMistake* one) { return one->mistake == visibility_term; }) &&
           evidence_.rays_to_visible > 0;
  }

  void find_in_choices() {
    constexpr double level = 1e-8;
    const double p_several = p_value_of_points(false), p_alone = p_value_of_points(true);
    const bool are_uniform = p_several > level && p_alone > level;
    // A number that has chosen between light and BSDF leaves out lights as well.
    if (!are_uniform && evidence_.bsdf_samples > 0) {
      add(sample_shared_with_bsdf, "",
          "the numbers that place points on lights are not uniform, and the BSDF is sampled too");
      return;
    }
    if (const std::string never = lights_never_chosen(); !never.empty())
      add(light_never_chosen, "", "in none of the probes' samples: " + never);
    if (are_uniform) return;
    if (p_alone > level)
      add(number_used_twice, "",
          fmt::format("with several lights the numbers that place points are not uniform (p = {:.1e}); with "
                      "one they are",
                      p_several));
    else
      result_.is_unknown = true;
  }

  std::string lights_never_chosen() const {
    std::string never;
    for (const std::vector<PointsOfLight>& lights : evidence_.points) {
      double drawn = 0;
      for (const PointsOfLight& points : lights) drawn += points.drawn;
      if (drawn < 40 * double(lights.size())) continue;
      for (std::size_t light = 0; light < lights.size(); ++light)
        if (lights[light].drawn == 0)
          never += fmt::format("{}light {} of {}", never.empty() ? "" : ", ", light + 1, lights.size());
    }
    return never;
  }

  /// Of uniform points, in the probes with one light or in those with several.
  double p_value_of_points(bool is_alone) const {
    std::vector<double> observed, expected;
    for (const std::vector<PointsOfLight>& lights : evidence_.points)
      for (const PointsOfLight& points : lights) {
        if ((lights.size() == 1) != is_alone || points.drawn < 80) continue;
        for (const double count : points.counts) {
          observed.push_back(count);
          expected.push_back(points.drawn / double(points.counts.size()));
        }
      }
    return observed.size() < 2 ? 1 : chi_squared_test(observed, expected).p_value;
  }

  void find_shared_numbers() {
    if (evidence_.numbers_shared_with_bsdf > 0)
      add(sample_shared_with_bsdf, "",
          fmt::format("in {} of {} samples a light's point and the BSDF's sample were made of one number",
                      evidence_.numbers_shared_with_bsdf, evidence_.samples_recorded));
    if (evidence_.not_repeated > 0 || evidence_.without_numbers > 0)
      add(foreign_random_numbers, "",
          evidence_.not_repeated > 0
              ? fmt::format("{} of {} samples with the same seed came out otherwise the second time",
                            evidence_.not_repeated, evidence_.repeated)
              : fmt::format("{} of {} samples have drawn no number of the sampler", evidence_.without_numbers,
                            evidence_.samples_recorded));
  }

  bool has(MistakeClass mistake) const {
    return std::ranges::any_of(result_.findings, [&](const FoundMistake& f) { return f.mistake == mistake; });
  }

  void find_in_values() {
    if (evidence_.invalid > 0)
      add(invalid_values, "not a number, or infinite",
          fmt::format("{} of {} samples; the first: {}", evidence_.invalid, evidence_.samples_in_all,
                      evidence_.first_invalid));
    else if (evidence_.negative > 0 && result_.findings.empty())
      add(invalid_values, "negative",
          fmt::format("{} of {} samples; the first: {}", evidence_.negative, evidence_.samples_in_all,
                      evidence_.first_invalid));
  }

  /// What comes from a light that is seen, but for what it reflects: over what it emits.
  double share_of_emission(std::size_t ray) const {
    double rest = 0, count = 0;
    for (const SampleEvidence& sample : samples_) {
      if (sample.ray != ray) continue;
      rest += sum_of_channels(sample.value) - sum_of_channels(predicted(sample, result_.fit));
      ++count;
    }
    return rest / (count * sum_of_channels(evidence_.rays[ray].emitted));
  }

  void find_in_emission() {
    for (std::size_t i = 0; i < evidence_.rays.size(); ++i) {
      const RayEvidence& ray = evidence_.rays[i];
      if (sum_of_channels(ray.emitted) == 0 || has(nothing_returned)) continue;
      constexpr double alike = 1e-2;
      const double share = share_of_emission(i);
      if (std::abs(share) < alike)
        add(emission_missing, "they are black",
            fmt::format("a light that shines with {:.4g} is seen with {:.4g}", sum_of_channels(ray.emitted),
                        share * sum_of_channels(ray.emitted)));
      else if (std::isfinite(share) && std::abs(share - 1) > alike &&
               std::abs(share / result_.fit.factor - 1) > alike)
        result_.is_unknown = true;  // As bright as neither itself nor the factor of all makes it.
      else if (result_.findings.empty() && reflects_nothing(ray))
        add(emission_missing, "what they reflect of other lights",
            fmt::format(
                "a light that shines with {:.4g} reflects {:.4g} of another's light; it is seen with {:.4g}",
                sum_of_channels(ray.emitted), sum_of_channels(ray.expected) - sum_of_channels(ray.emitted),
                ray.sum_of_means()));
    }
  }

  static bool reflects_nothing(const RayEvidence& ray) {
    constexpr double little = 1e-3;
    const double emitted = sum_of_channels(ray.emitted), reflected = sum_of_channels(ray.expected) - emitted;
    return reflected > little * emitted && std::abs(ray.sum_of_means() - emitted) < 0.05 * reflected;
  }

  const ProbeEvidence& evidence_;
  std::vector<SampleEvidence> samples_;
  TermFits fits_;
  Diagnosis result_;
};

}  // namespace

Diagnosis diagnose(const ProbeEvidence& evidence, bool is_wrong) { return Diagnosing(evidence).of(is_wrong); }

}  // namespace etendue

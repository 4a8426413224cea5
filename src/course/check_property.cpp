#include "course/check_property.h"

#include "stats/significance.h"
#include "stats/t_test.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace etendue {

namespace {

constexpr const char* channel_names[]{"red", "green", "blue"};

/// What the grid of the expected value may be wrong by, of the ray's largest channel.
double allowance_of(const RayEvidence& ray) {
  const double scale = std::max({ray.expected.r, ray.expected.g, ray.expected.b});
  return scale * (ray.of == ProbeOf::shadows ? 1e-3 : 3e-4) + 1e-7;
}

/// Of a channel: where few samples bring nearly all, as of a light that is hidden but for a sliver, 8192 of
/// them are too few for a t-test. So many have the weight of 400 alike ones.
constexpr double least_evenness = 0.05;

double p_value(const RunningStatistics& values, double expected, double allowance) {
  const double off = values.mean - expected;
  const double reference = values.mean - std::copysign(std::max(std::abs(off) - allowance, 0.0), off);
  const double p = t_test(values, reference).p_value;
  return std::isfinite(p) ? p : 0;
}

struct Tested {
  std::int64_t tests = 0;
  double p = 1;
  std::string worst;

  void take(double p_of_one, const std::function<std::string()>& what) {
    ++tests;
    if (p_of_one >= p) return;
    p = p_of_one;
    worst = what();
  }
};

using IsAmong = std::function<bool(const RayEvidence&)>;

Tested test_means(const ProbeEvidence& evidence, const IsAmong& is_among) {
  Tested tested;
  for (std::size_t i = 0; i < evidence.rays.size(); ++i) {
    const RayEvidence& ray = evidence.rays[i];
    if (!is_among(ray)) continue;
    const double expected[3]{ray.expected.r, ray.expected.g, ray.expected.b};
    const double evenness[3]{ray.evenness.r, ray.evenness.g, ray.evenness.b};
    for (std::size_t c = 0; c < 3; ++c) {
      if (evenness[c] < least_evenness) continue;
      tested.take(p_value(ray.channels[c], expected[c], allowance_of(ray)), [&] {
        return fmt::format("{}, ray {}, {}: {:.5g} +- {:.2g}, and {:.5g} is right", evidence.names[ray.probe],
                           i, channel_names[c], ray.channels[c].mean, ray.channels[c].standard_error(),
                           expected[c]);
      });
    }
  }
  return tested;
}

Tested test_shares(const ProbeEvidence& evidence) {
  Tested tested;
  for (std::size_t i = 0; i < evidence.rays.size(); ++i) {
    const RayEvidence& ray = evidence.rays[i];
    if (ray.of != ProbeOf::unshadowed || evidence.areas[ray.probe].size() < 2) continue;
    const double expected[3]{ray.expected.r, ray.expected.g, ray.expected.b};
    const double all = expected[0] + expected[1] + expected[2];
    const double mean = ray.sum_of_means();
    for (std::size_t c = 0; c < 3; ++c)
      tested.take(p_value(ray.shares[c], 0, allowance_of(ray)), [&] {
        return fmt::format("{}, ray {}: the {} light has {:.4f} of all, and {:.4f} is right",
                           evidence.names[ray.probe], i, channel_names[c],
                           mean != 0 ? ray.channels[c].mean / mean : 0, expected[c] / all);
      });
  }
  return tested;
}

/// Recorded samples of a single point that `is_dark` says must be black, and how many are not.
std::string bright_ones(const ProbeEvidence& evidence,
                        const std::function<bool(const LightPointFacts&)>& is_dark, bool& is_any) {
  std::int64_t dark = 0, bright = 0;
  for (const SampleEvidence& sample : evidence.samples) {
    if (sample.points.size() != 1 || evidence.rays[sample.ray].is_light || !is_dark(sample.points[0]))
      continue;
    ++dark;
    bright += sample.value.r != 0 || sample.value.g != 0 || sample.value.b != 0;
  }
  is_any = bright > 0;
  return fmt::format("{} of {} samples that must be black are not", bright, dark);
}

class Judging {
 public:
  explicit Judging(const ProbeEvidence& evidence)
      : evidence_(evidence),
        tests_(test_means(evidence, [](const RayEvidence&) { return true; }).tests +
               test_shares(evidence).tests) {}

  std::vector<CheckedProperty> judge() {
    const auto of = [](ProbeOf what) { return [what](const RayEvidence& ray) { return ray.of == what; }; };
    const Tested mean = test_means(evidence_, [](const RayEvidence&) { return true; });
    add("mean", mean, "all means are right");
    add_shares();
    const bool is_plain_right =
        add("unshadowed", test_means(evidence_, of(ProbeOf::unshadowed)), "without shadows all is right");
    add_kind("shadows", of(ProbeOf::shadows), is_plain_right,
             [](const LightPointFacts& p) { return !p.is_visible; });
    add_kind("back faces", of(ProbeOf::back_faces), is_plain_right,
             [](const LightPointFacts& p) { return p.cos_light < -1e-4; });
    add_kind("horizon", of(ProbeOf::horizon), is_plain_right,
             [](const LightPointFacts& p) { return p.cos_receiver < -1e-4; });
    add("emission", test_means(evidence_, of(ProbeOf::emission)), "lights look as bright as they are");
    add_exact(
        "valid samples", evidence_.invalid + evidence_.negative,
        fmt::format("{} of {} samples are not numbers or infinite, {} are negative; the first: {}",
                    evidence_.invalid, evidence_.samples_in_all, evidence_.negative, evidence_.first_invalid),
        fmt::format("all of {} samples are finite and not negative", evidence_.samples_in_all));
    add_exact("repeatable", evidence_.not_repeated,
              fmt::format("{} of {} samples came out otherwise the second time", evidence_.not_repeated,
                          evidence_.repeated),
              "the same seed gives the same samples");
    add_sampler();
    add_threads();
    return std::move(properties_);
  }

 private:
  bool is_wrong(const Tested& tested) const { return is_rejected(tested.p, level_of_probes, tests_); }

  bool add(const char* name, const Tested& tested, const char* all_is_well) {
    const bool is_bad = is_wrong(tested);
    properties_.push_back({name, is_bad ? PropertyVerdict::wrong : PropertyVerdict::right,
                           is_bad ? tested.worst : all_is_well, tested.tests, tested.p});
    return !is_bad;
  }

  /// Where all is wrong already, only what must be black says whether this is, too.
  void add_kind(const char* name, const IsAmong& is_among, bool is_plain_right,
                const std::function<bool(const LightPointFacts&)>& is_dark) {
    const bool is_good = add(name, test_means(evidence_, is_among), "as it should be");
    if (is_good || is_plain_right) return;
    bool is_any = false;
    CheckedProperty& property = properties_.back();
    property.what = bright_ones(evidence_, is_dark, is_any);
    property.verdict = is_any ? PropertyVerdict::wrong : PropertyVerdict::cannot_tell;
    if (!is_any) property.what = "what is wrong everywhere hides it; what must be black is";
  }

  void add_shares() {
    const bool is_black =
        std::all_of(evidence_.rays.begin(), evidence_.rays.end(), [](const RayEvidence& ray) {
          return ray.is_light ||
                 (ray.channels[0].mean == 0 && ray.channels[1].mean == 0 && ray.channels[2].mean == 0);
        });
    if (is_black)
      properties_.push_back({"light shares", PropertyVerdict::cannot_tell, "no light has arrived"});
    else
      add("light shares", test_shares(evidence_), "each light has its share");
  }

  void add_exact(const char* name, std::int64_t bad, const std::string& what,
                 const std::string& all_is_well) {
    properties_.push_back(
        {name, bad > 0 ? PropertyVerdict::wrong : PropertyVerdict::right, bad > 0 ? what : all_is_well});
  }

  void add_sampler() {
    std::string what;
    if (evidence_.without_numbers > 0)
      what = fmt::format("{} of {} samples chose their points without a number of the sampler",
                         evidence_.without_numbers, evidence_.samples_recorded);
    else if (evidence_.numbers_shared_with_bsdf > 0)
      what = fmt::format("in {} of {} samples one number served a light's point and the BSDF's sample",
                         evidence_.numbers_shared_with_bsdf, evidence_.samples_recorded);
    properties_.push_back({"use of the sampler",
                           what.empty() ? PropertyVerdict::right : PropertyVerdict::wrong,
                           what.empty() ? "all numbers are the sampler's" : what});
  }

  void add_threads() {
    if (evidence_.not_repeated > 0)
      properties_.push_back(
          {"thread safety", PropertyVerdict::cannot_tell, "what one thread does cannot be repeated"});
    else
      add_exact("thread safety", evidence_.not_alike_in_threads,
                fmt::format("{} samples came out otherwise while other threads ran: something is shared that "
                            "changes",
                            evidence_.not_alike_in_threads),
                "four threads at once give the same samples");
  }

  const ProbeEvidence& evidence_;
  std::int64_t tests_;
  std::vector<CheckedProperty> properties_;
};

}  // namespace

std::string_view verdict_name(PropertyVerdict verdict) {
  switch (verdict) {
    case PropertyVerdict::right:
      return "right";
    case PropertyVerdict::wrong:
      return "wrong";
    case PropertyVerdict::cannot_tell:
      break;
  }
  return "cannot tell";
}

std::vector<CheckedProperty> properties_of(const ProbeEvidence& evidence) {
  return Judging(evidence).judge();
}

std::vector<bool> wrong_probes(const ProbeEvidence& evidence) {
  const std::int64_t tests = test_means(evidence, [](const RayEvidence&) { return true; }).tests;
  std::vector<bool> wrong;
  for (std::size_t probe = 0; probe < evidence.names.size(); ++probe)
    wrong.push_back(
        is_rejected(test_means(evidence, [probe](const RayEvidence& ray) { return ray.probe == probe; }).p,
                    level_of_probes, tests));
  return wrong;
}

}  // namespace etendue

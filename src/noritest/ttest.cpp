// Student's t-test of "the mean is the reference", for scenes, BSDFs and emitters.
//
// The rules are those of Nori's ttest (W. Jakob): the number of samples, the level of the whole file and its
// Sidak correction, and a least variance. Two are stricter here: samples that are all 0 never pass for
// another reference, however small, and a sample that is negative or not finite fails its case.
#include "base/hash.h"
#include "noritest/case_runner.h"
#include "noritest/random_squares.h"
#include "noritest/scene_luminance.h"
#include "scene/load_light.h"
#include "scene/load_scene.h"
#include "scenefile/value_text.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

namespace etendue {

using Type = Parameter::Type;

const Plugin ttest_plugin{
    "test",
    "ttest",
    "Student's t-tests of the mean luminance of scenes, of BSDFs under uniform light, or from emitters.",
    {{"references", Type::text, "", "", "The expected means, one for each case", true},
     {"angles", Type::text, "", "deg", "Of BSDFs: between the normal and the direction to the viewer"},
     {"distances", Type::text, "", "m", "Of emitters: places of the receiver on the z axis"},
     {"significanceLevel", Type::real, "0.01", "", "Of all cases of the file together"},
     {"sampleCount", Type::integer, "100000", "", "Samples a case; at least 2"}},
    {"scene", "bsdf", "brdf", "emitter", "luminaire"}};

namespace {

constexpr std::int64_t samples_between_checks = 65536;

struct TTestRules {
  double level;
  std::int64_t sample_count;
  double variance_floor;
  std::int64_t tests;
};

std::vector<double> listed_numbers(const Parameters& parameters, std::string_view name) {
  if (!parameters.has(name)) return {};
  return parse_reals(parameters.text(name), parameters.location(name));
}

double significance_level(const Parameters& parameters) {
  const double level = parameters.real("significanceLevel");
  if (!(level > 0 && level < 1))
    throw InputError(parameters.location("significanceLevel"),
                     fmt::format("'significanceLevel' is {}; it must lie between 0 and 1", level));
  return level;
}

void judge_mean(CaseResult& result, const RunningStatistics& samples, std::int64_t invalid_samples,
                const TTestRules& rules) {
  const MeanTest test = t_test(samples, result.reference, rules.variance_floor);
  result.mean = samples.mean;
  result.statistic = test.statistic;
  result.p_value = test.p_value;
  if (invalid_samples > 0) {
    result.problem =
        fmt::format("{} of {} samples are negative or not finite", invalid_samples, samples.count);
  } else if (samples.mean == 0 && samples.m2 == 0 && result.reference != 0) {
    result.p_value = 0;
    result.problem = "all samples are 0";
  }
  result.is_passed = result.problem.empty() && !is_rejected(result.p_value, rules.level, rules.tests);
}

void test_scene(TestRun& run, const Object& scene, double reference, std::uint64_t seed,
                const TTestRules& rules) {
  CaseResult result{.kind = "ttest", .subject = "scene", .reference = reference};
  result.type = IntegratorSettings{}.name;
  for (const Object& child : scene.children)
    if (child.family == "integrator") result.type = child.type;
  run.run_case(result, [&](CaseResult& measured) {
    const SceneDesc description{scene, run.test.dialect, run.test.dialect_reason, run.test.directory, {}};
    LoadedScene loaded = load_scene(description);
    std::vector<UnreadKey> unread;
    const IntegratorSettings integrator = loaded.integrator.family.empty()
                                              ? IntegratorSettings{}
                                              : make_integrator(loaded.integrator, run.test.dialect, unread);
    run.warnings.insert(run.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    run.warn(unread);
    if (const std::string unseen = unseen_lights(integrator, loaded.scene.lights.dirac_count());
        !unseen.empty())
      run.warnings.push_back(unseen);
    if (integrator.needs_lights() && reference != 0) check_has_light(description, loaded.scene);
    const SceneLuminance luminances =
        sample_luminance(loaded.scene, integrator, rules.sample_count, run.settings, seed);
    judge_mean(measured, luminances.samples, luminances.invalid_samples, rules);
  });
}

/// Luminances of single samples; what is negative or not finite is counted, and is 0.
struct Samples {
  RunningStatistics luminances;
  std::int64_t invalid = 0;

  void add(const Colorf& sample) {
    const auto is_valid = [](float channel) { return std::isfinite(channel) && channel >= 0; };
    const bool valid = is_valid(sample.r) && is_valid(sample.g) && is_valid(sample.b);
    invalid += !valid;
    luminances.add(valid ? luminance(sample) : 0);
  }
};

/// The luminance that a BSDF sends to the viewer under uniform light of radiance 1: the mean weight of its
/// samples.
void test_bsdf(TestRun& run, const Object& bsdf, double angle_deg, double reference, std::uint64_t seed,
               const TTestRules& rules) {
  CaseResult result{.kind = "ttest",
                    .subject = "bsdf",
                    .type = bsdf.type,
                    .detail = fmt::format("at {} degrees", angle_deg),
                    .reference = reference,
                    .is_reference_estimated = true};
  run.run_case(result, [&](CaseResult& measured) {
    std::vector<UnreadKey> unread;
    TextureFiles textures{run.test.directory};
    const Material material = make_material(bsdf, textures, unread);
    run.warn(unread);
    const double angle = angle_deg * std::numbers::pi / 180;
    const Vec3f wo{float(std::sin(angle)), 0, float(std::cos(angle))};
    const RandomSquares u_bsdf(run.settings.sampler, seed);
    Samples samples;
    std::visit(
        [&](const auto& model) {
          const auto at_point = model.at(Vec2f{0, 0}, true);
          for (std::int64_t i = 0; i < rules.sample_count; ++i) {
            if (i % samples_between_checks == 0) throw_if_stopped(run.settings);
            samples.add(at_point.sample(wo, u_bsdf[std::uint32_t(i)]).weight);
          }
        },
        material);
    judge_mean(measured, samples.luminances, samples.invalid, rules);
  });
}

/// How the forks count references for several BSDFs; for one BSDF they all agree.
enum class ReferenceOrder {
  each_bsdf_and_angle,  ///< ETH, Tuebingen: one for each BSDF at each angle.
  each_angle,           ///< 2012: all BSDFs share angles and references.
  own_angles            ///< Current Nori: all share the references, each has angles of its own.
};

ReferenceOrder reference_order(const Parameters& parameters, std::size_t references, std::size_t bsdfs,
                               std::size_t angles) {
  if (references == bsdfs * angles) return ReferenceOrder::each_bsdf_and_angle;
  if (references == angles) return ReferenceOrder::each_angle;
  if (references * bsdfs == angles) return ReferenceOrder::own_angles;
  throw InputError(parameters.location("references"),
                   fmt::format("{} references for {} angles and {} BSDFs", references, angles, bsdfs),
                   "there must be as many as angles, or as many as angles times BSDFs");
}

void test_bsdfs(TestRun& run, const Parameters& parameters, const std::vector<const Object*>& bsdfs,
                const std::vector<double>& references, const TTestRules& rules) {
  const std::vector<double> angles = listed_numbers(parameters, "angles");
  const ReferenceOrder order = reference_order(parameters, references.size(), bsdfs.size(), angles.size());
  const std::size_t angles_a_bsdf = order == ReferenceOrder::own_angles ? references.size() : angles.size();
  for (std::size_t b = 0; b < bsdfs.size(); ++b)
    for (std::size_t a = 0; a < angles_a_bsdf; ++a) {
      const std::size_t number = b * angles_a_bsdf + a;
      test_bsdf(run, *bsdfs[b], angles[order == ReferenceOrder::own_angles ? number : a],
                references[order == ReferenceOrder::each_bsdf_and_angle ? number : a],
                hash64(hash64(run.settings.seed) + number), rules);
    }
}

/// The luminance that arrives at (0, 0, distance) from an emitter that stands alone.
void test_emitter(TestRun& run, const Object& emitter, double distance, double reference, std::uint64_t seed,
                  const TTestRules& rules) {
  CaseResult result{.kind = "ttest",
                    .subject = "emitter",
                    .type = emitter.type,
                    .detail = fmt::format("at {} m", distance),
                    .reference = reference};
  run.run_case(result, [&](CaseResult& measured) {
    if (emitter.type == area_light_name)
      throw InputError(emitter.location, "an area light is a shape: without one it cannot be tested",
                       "put it into a <mesh> of a <scene>");
    std::vector<UnreadKey> unread;
    Lights lights;
    add_light(emitter, run.test.directory, lights, unread);
    run.warn(unread);
    const RandomSquares u_light(run.settings.sampler, seed);
    // Without a surface: any normal will do.
    const Receiver<float> receiver{{0, 0, float(distance)}, {0, 0, 1}, {0, 0, 1}, lit_side::medium};
    Samples samples;
    for (std::int64_t i = 0; i < rules.sample_count; ++i) {
      if (i % samples_between_checks == 0) throw_if_stopped(run.settings);
      const LightSample<float> sample =
          lights.sample<float>(0, 1, receiver, u_light.bits(std::uint32_t(i)), true);
      samples.add(sample.is_there ? sample.radiance_over_pdf : Colorf{0, 0, 0});
    }
    judge_mean(measured, samples.luminances, samples.invalid, rules);
  });
}

void test_emitters(TestRun& run, const Parameters& parameters, const std::vector<const Object*>& emitters,
                   const std::vector<double>& references, const TTestRules& rules) {
  const std::vector<double> distances = listed_numbers(parameters, "distances");
  if (references.size() != emitters.size() * distances.size())
    throw InputError(
        parameters.location("references"),
        fmt::format("{} references for {} distances and {} emitters; there must be one for each of "
                    "each",
                    references.size(), distances.size(), emitters.size()));
  for (std::size_t i = 0; i < references.size(); ++i)
    test_emitter(run, *emitters[i / distances.size()], distances[i % distances.size()], references[i],
                 hash64(hash64(run.settings.seed) + i), rules);
}

void test_scenes(TestRun& run, const Parameters& parameters, const std::vector<const Object*>& scenes,
                 const std::vector<double>& references, const TTestRules& rules) {
  if (references.size() != scenes.size())
    throw InputError(parameters.location("references"),
                     fmt::format("{} references for {} scenes; there must be one for each", references.size(),
                                 scenes.size()));
  for (std::size_t i = 0; i < scenes.size(); ++i)
    test_scene(run, *scenes[i], references[i], hash64(hash64(run.settings.seed) + i), rules);
}

}  // namespace

void run_ttest(TestRun& run) {
  std::vector<UnreadKey> unread;
  const Parameters parameters(run.test.root, ttest_plugin, unread);
  run.warn(unread);
  const std::vector<double> references = listed_numbers(parameters, "references");
  const TTestRules rules{significance_level(parameters), parameters.integer("sampleCount"),
                         run.test.dialect == Dialect::nori_2012 ? 1e-4 : 1e-5,
                         std::int64_t(references.size())};
  if (rules.sample_count < 2)
    throw InputError(parameters.location("sampleCount"),
                     fmt::format("'sampleCount' is {}; it must be at least 2", rules.sample_count));
  std::vector<const Object*> scenes, bsdfs, emitters;
  for (const Object& child : run.test.root.children)
    (child.family == "scene" ? scenes : is_light(child) ? emitters : bsdfs).push_back(&child);
  if (int(scenes.empty()) + int(bsdfs.empty()) + int(emitters.empty()) != 2)
    throw InputError(run.test.root.location,
                     run.test.root.children.empty() ? "this test has nothing to test"
                                                    : "this test has subjects of several kinds",
                     "put either <scene> or <bsdf> or <emitter> elements into a ttest");
  if (!scenes.empty())
    test_scenes(run, parameters, scenes, references, rules);
  else if (!bsdfs.empty())
    test_bsdfs(run, parameters, bsdfs, references, rules);
  else
    test_emitters(run, parameters, emitters, references, rules);
}

}  // namespace etendue

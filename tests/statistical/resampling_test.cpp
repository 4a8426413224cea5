// Light samples that are one of several candidates: whatever the light sampler, the weights and the number of
// candidates, their mean is the exact irradiance, and that of the other estimators; what is not a number
// stays visible; and the points stay stratified.
//
// False-alarm rate of this file: 1e-5 (Sidak over all its t-tests), fixed seeds.
#include "integrator/resampling.h"

#include "closed_forms.h"
#include "film_statistics.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 2000;  // At least as many tests as are made below.

// The choice itself.

DirectLightSample<float> candidate_of(const Colorf& adds, std::int32_t light) {
  DirectLightSample<float> candidate{};
  candidate.light = no_light_sample<float>();
  candidate.light.light = light;
  candidate.unshadowed = adds;
  candidate.needs_shadow_ray = !is_black(adds);
  return candidate;
}

TEST(ResampledLight, StandsForAllCandidates) {
  const std::vector<std::vector<Colorf>> sets{
      {{1, 2, 3}},
      {{1, 2, 3}, {0, 0, 0}, {4, 0.1f, 1e-3f}},
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 2}, {7, 0, 0}},
      {{1e-20f, 1e-20f, 1e-20f}, {1e10f, 1e10f, 1e10f}, {1, 1, 1}},
      {{1, 1, 1}, {1, 1, 1}, {2, 1, 0.5f}, {0.3f, 1, 1}, {0, 0, 0}, {3, 3, 3}, {0, 1, 0}}};
  constexpr int numbers = 1 << 16;
  for (const std::vector<Colorf>& set : sets) {
    Color<double> mean{0, 0, 0}, exact{0, 0, 0};
    std::vector<int> kept(set.size());
    std::int32_t last = -1;
    for (const Colorf& adds : set) exact = exact + Color<double>{adds.r, adds.g, adds.b};
    for (int i = 0; i < numbers; ++i) {
      ResampledLight<float> resampled((float(i) + 0.5f) / numbers);
      for (std::size_t k = 0; k < set.size(); ++k) resampled.offer(candidate_of(set[k], std::int32_t(k)));
      const DirectLightSample<float> sample = resampled.take();
      ASSERT_TRUE(sample.needs_shadow_ray);
      mean = mean + Color<double>{sample.unshadowed.r, sample.unshadowed.g, sample.unshadowed.b};
      ++kept[std::size_t(sample.light.light)];
      last = sample.light.light;
    }
    EXPECT_GE(last, 0);
    const double tolerance = 1e-3;  // A count may be off by one or two at each end of a candidate's numbers.
    EXPECT_NEAR(mean.r / numbers, exact.r, tolerance * exact.r);
    EXPECT_NEAR(mean.g / numbers, exact.g, tolerance * exact.g);
    EXPECT_NEAR(mean.b / numbers, exact.b, tolerance * exact.b);
    double total = 0;
    for (const Colorf& adds : set) total += luminance(adds);
    for (std::size_t k = 0; k < set.size(); ++k)
      EXPECT_NEAR(kept[k], numbers * luminance(set[k]) / total, 3) << k;
  }
}

TEST(ResampledLight, IsNotThereWhereNoCandidateAddsAnything) {
  ResampledLight<float> resampled(0.3f);
  for (int k = 0; k < 4; ++k) resampled.offer(candidate_of({0, 0, 0}, k));
  EXPECT_FALSE(resampled.take().needs_shadow_ray);
}

TEST(ResampledLight, LosesNoNotANumber) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  infinity = std::numeric_limits<float>::infinity();
  for (const float odd : {nan, infinity})
    for (int at = 0; at < 3; ++at)
      for (const float u : {0.0f, 0.4f, 0x1.fffffep-1f}) {
        ResampledLight<float> resampled(u);
        for (int k = 0; k < 3; ++k) {
          const float adds = k == at ? odd : float(k);
          resampled.offer(candidate_of({adds, adds, adds}, k));
        }
        const DirectLightSample<float> sample = resampled.take();
        EXPECT_TRUE(sample.needs_shadow_ray);
        EXPECT_FALSE(std::isfinite(sample.unshadowed.g)) << at << ' ' << u;
      }
}

TEST(ResampledLight, ThatIsInvalidIsReported) {
  const LoadedScene loaded = load_scene_text(
      camera_xml({0, 0, 4}, {0, 0, 0}, 40, 16, "sobol") +
      rectangle_xml({0, 0, 0}, {9, 0, 0}, {0, 9, 0}, phong_xml(0.5, 0.3, 20)) +
      sphere_xml({1, 0, 1.5}, 0.6, light_xml(3)) + sphere_xml({-1, 0.5, 1}, 0.8, light_xml(3e38)));
  for (const char* integrator : {"direct_light", "path"})
    for (const int candidates : {1, 4}) {
      RenderSettings settings = render_settings(integrator, 16, 4, 5);
      settings.integrator = with_candidates(settings.integrator, candidates);
      EXPECT_GT(render(loaded.scene, settings).invalid.count(), 0) << integrator << ", " << candidates;
    }
}

// Means.

struct Weights {
  const char* name;
  DirectLight (*of)(const LightSamples& lights);
};
constexpr Weights all_weights[]{
    {"light samples alone", [](const LightSamples& lights) -> DirectLight { return ByLights{lights}; }},
    {"balance",
     [](const LightSamples& lights) -> DirectLight {
       return ByBoth{Heuristic::balance, lights};
     }},
    {"power",
     [](const LightSamples& lights) -> DirectLight {
       return ByBoth{Heuristic::power, lights};
     }},
    {"power where glossy", [](const LightSamples& lights) -> DirectLight {
       return ByBoth{Heuristic::power, lights, 1, true};
     }}};

/// f(rules, what) for every light sampler, weights, number of candidates, and technique.
template <class Function>
void for_all_rules(PathRules (*paths)(const DirectLight&), Function&& f) {
  for (const Plugin& sampler : light_sampler_plugins())
    for (const LightTechnique technique : {LightTechnique::area, LightTechnique::solid_angle,
                                           LightTechnique::projected_solid_angle, LightTechnique::automatic})
      for (const Weights& weights : all_weights)
        for (const int candidates : {1, 2, 4, 16}) {
          if (candidates % 2 == 0 && candidates != 4 && technique != LightTechnique::area) continue;
          const LightSamples lights{.count = candidates == 2 ? 2 : 1,
                                    .sampler = known_light_sampler(sampler.name),
                                    .candidates = candidates,
                                    .technique = technique};
          f(paths(weights.of(lights)),
            fmt::format("{}, {}, {}, {} candidates", sampler.name, light_technique_name(technique),
                        weights.name, candidates));
        }
}

constexpr double albedo = 0.6, radiance = 3;
constexpr int side_px = 12;

struct ExactCase {
  std::string name, lights;
  std::vector<SceneFile> files;
  double irradiance;  ///< At the origin, from above.
  /// Relative variance of a pixel that a test assumes at the least: rounding where the technique leaves none,
  /// and the rays that meet the light where these are too few to be normally distributed.
  double variance_floor = 1e-8;
};

std::vector<ExactCase> exact_cases() {
  const Vec3d up{0, 0, 1}, origin{0, 0, 0};
  std::vector<ExactCase> cases;
  const auto add_rectangle = [&](const char* name, const Vec3d& center, const Vec3d& u, const Vec3d& v) {
    cases.push_back({name,
                     rectangle_xml(center, u, v, light_xml(radiance)),
                     {},
                     polygon_irradiance(rectangle_corners(center, u, v), radiance, origin, up),
                     4e-4});
  };
  const Vec3d center{1, 0.5, 1}, half_u{0.5, 0, 0}, half_v{0, -0.5, 0}, sphere_center{-1, 0.8, 1.2};
  const std::vector<Vec3d> triangle{{-0.5, -1.6, 1.2}, {-0.4, -0.4, 1.6}, {0.6, -1, 1.4}};
  cases.push_back({"three lights",
                   rectangle_xml(center, half_u, half_v, light_xml(2)) +
                       sphere_xml(sphere_center, 0.4, light_xml(5)) + mesh_xml("light.obj", light_xml(4)),
                   {{"light.obj", polygon_obj(triangle)}},
                   polygon_irradiance(rectangle_corners(center, half_u, half_v), 2, origin, up) +
                       sphere_irradiance(sphere_center, 0.4, 5, origin, up) +
                       polygon_irradiance(triangle, 4, origin, up)});
  // Two walls that shine, which stand on the floor; one of them close by.
  const Vec3d near_center{-0.2, 0, 0.5}, far_center{1, 0, 0.5}, wall_u{0, 0.5, 0}, wall_v{0, 0, 0.5};
  cases.push_back(
      {"touching the floor",
       rectangle_xml(near_center, wall_u, wall_v, light_xml(radiance)) +
           rectangle_xml(far_center, -wall_u, wall_v, light_xml(radiance)),
       {},
       polygon_irradiance(rectangle_corners(near_center, wall_u, wall_v), radiance, origin, up) +
           polygon_irradiance(rectangle_corners(far_center, -wall_u, wall_v), radiance, origin, up)});
  add_rectangle("a sliver", {0.3, -0.4, 0.7}, {1.5, 0.2, 0.1}, {0, -0.002, 0});
  // Its plane passes 3 cm beside the place.
  add_rectangle("edge on", {0.8, 0, 0.8}, {-0.1, -0.2, -0.1}, {0.2, 0, 0.2125});
  std::string lamps;
  double sum = 0;
  for (int k = 0; k < 300; ++k) {
    // At one height, so that none hides another.
    const Vec3d at{-1.97 + 0.2 * (k % 20), -1.5 + 0.2 * (k / 20), 1}, u{0.05, 0, 0}, v{0, -0.05, 0};
    lamps += rectangle_xml(at, u, v, light_xml(1 + k % 11));
    sum += polygon_irradiance(rectangle_corners(at, u, v), 1 + k % 11, origin, up);
  }
  cases.push_back({"three hundred lamps", lamps, {}, sum});
  return cases;
}

class ExactIrradiance : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ExactIrradiance, IsTheMeanOfEveryCombination) {
  const ExactCase c = exact_cases()[GetParam()];
  ASSERT_GT(c.irradiance, 1e-4);
  const LoadedScene loaded =
      load_scene_text(camera_xml({1.5, -2.5, 2}, {0, 0, 0}, 0.001, side_px, "sobol") +
                          rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, diffuse_xml(albedo)) + c.lights,
                      c.files);
  const double exact = albedo / std::numbers::pi * c.irradiance;
  for_all_rules(PathRules::direct, [&](const PathRules& rules, const std::string& what) {
    RenderSettings settings = render_settings("mis", 16, 1, 7);
    settings.integrator.rules = rules;
    if (rules.light_samples()->sampler == "all" && loaded.scene.lights.count() > 100) {
      if (rules.candidates(0) > 2) return;
      settings.samples_per_pixel = 1;
    }
    const RenderResult result = render(loaded.scene, settings);
    EXPECT_EQ(result.invalid.count(), 0);
    const RunningStatistics mean = statistics_of_pixels(result.film, &Color<double>::g);
    const MeanTest test = t_test(mean, exact, exact * exact * c.variance_floor);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << what << ": " << mean.mean << " +- " << mean.standard_error() << ", exact " << exact << ", "
        << test.statistic << " standard errors";
    EXPECT_LT(mean.standard_error() / exact, 0.05) << what << ": too few samples";
  });
}

INSTANTIATE_TEST_SUITE_P(Cases, ExactIrradiance, ::testing::Range(std::size_t{0}, exact_cases().size()),
                         [](const auto& info) {
                           std::string name = exact_cases()[info.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// Other surfaces, media, other lights: the integrators that resample against those that do not.

/// Glossy and smooth surfaces, a mirror, glass; lamps of all kinds.
std::string things_xml() {
  return rectangle_xml({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, phong_xml(0.4, 0.3, 30)) +
         rectangle_xml({0, 3, 2}, {4, 0, 0}, {0, 0, 2}, diffuse_xml(0.5)) +
         rectangle_xml({-2.5, 1, 1.5}, {0.3, 1, 0}, {0, 0, 1}, "<bsdf type=\"mirror\"/>") +
         sphere_xml({1, -0.5, 0.7}, 0.6, "<bsdf type=\"dielectric\"/>") +
         sphere_xml({-1, -1, 0.5}, 0.5,
                    "<bsdf type=\"roughdielectric\"><float name=\"alpha\" value=\"0.3\"/></bsdf>") +
         rectangle_xml({-2, 0, 3}, {0.7, 0, 0.2}, {0, -0.5, 0}, light_xml(6)) +
         sphere_xml({1.8, 0.5, 2}, 0.5, light_xml(4) + diffuse_xml(0.1));
}

struct AgreementCase {
  const char* name;
  std::string more;
};
std::vector<AgreementCase> agreement_cases() {
  std::string lamps;
  for (int k = 0; k < 400; ++k)
    lamps += rectangle_xml({-2.5 + 0.25 * (k % 20), -2.5 + 0.25 * (k / 20), 2 + 0.04 * (k % 7)},
                           {0.05, 0, 0.01}, {0, -0.05, 0}, light_xml(1 + k % 11));
  return {
      {"surfaces", ""},
      {"mist",
       "<medium type=\"homogeneous\"><color name=\"sigmaA\" value=\"0.02,0.05,0.1\"/><color name=\"sigmaS\" "
       "value=\"0.2\"/><transform name=\"toWorld\"><scale value=\"4,4,2\"/><translate "
       "value=\"-2,-2,0\"/></transform></medium>"},
      {"lights without surfaces",
       R"(<emitter type="point"><point name="position" value="0.3,0.5,1.2"/></emitter>
              <emitter type="spot"><point name="position" value="-0.5,-1,2"/>
                <vector name="direction" value="0.2,0.1,-1"/><float name="cutoffAngle" value="50"/></emitter>
              <emitter type="directional"><vector name="direction" value="0.5,0.2,-1"/></emitter>
              <emitter type="constant"><color name="radiance" value="0.1"/></emitter>)"},
      {"many lamps", lamps}};
}

struct Pair {
  const char *ours, *reference;
};

TEST(Agreement, OfTheIntegratorsThatResampleWithThoseThatDoNot) {
  constexpr int image_px = 20, block_px = 10;
  for (const AgreementCase& c : agreement_cases()) {
    const LoadedScene loaded =
        load_scene_text(camera_xml({0, -6, 2.5}, {0, 0, 0.7}, 45, image_px, "sobol") + things_xml() + c.more);
    for (const Pair& pair : {Pair{"direct_light", "mis"}, {"path", "path_mis"}}) {
      std::vector<Film> films;
      RenderResult reference = render(loaded.scene, render_settings(pair.reference, 512, 16, 3));
      EXPECT_EQ(reference.invalid.count(), 0);
      for (const int candidates : {1, 4})
        for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
          RenderSettings settings =
              render_settings(pair.ours, 96, 16, 4 + std::uint64_t(candidates), heuristic);
          settings.integrator = with_candidates(settings.integrator, candidates);
          const RenderResult result = render(loaded.scene, settings);
          EXPECT_EQ(result.invalid.count(), 0);
          for (int y = 0; y < image_px; y += block_px)
            for (int x = 0; x < image_px; x += block_px)
              for (const Channel64 channel : channels64) {
                const RunningStatistics a = block_mean(result.film, x, y, block_px, channel),
                                        b = block_mean(reference.film, x, y, block_px, channel);
                const MeanTest test = welch_t_test(a, b);
                EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
                    << c.name << ", " << pair.ours << ", " << candidates << " candidates, block at " << x
                    << ", " << y << ": " << a.mean << " +- " << a.standard_error() << ", " << pair.reference
                    << " " << b.mean << " +- " << b.standard_error() << ", t = " << test.statistic;
              }
        }
    }
  }
}

}  // namespace
}  // namespace etendue

// Every light sampler: lights are chosen with the probability that it states, what is left of the random
// number is uniform, no light of any power is left out, and the estimate has the mean of all lights' sum.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the power sampler states the pmf of the next light, or takes powers without the lights'
// areas; its least share is left out; the number left over is not stretched; `all` states the pmf 1/n.
#include "lightsampler/light_sampler.h"

#include "stats/chi_squared.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 60, samples = 200000;
constexpr Receiver<float> receiver{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, lit_side::front};

/// Squares of side 0.1 to 1 above the receiver, facing it, of mixed radiance; one in seven is black.
[[gnu::noinline]] Lights mixed_lights(std::int32_t count) {
  Lights lights;
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform;
  for (std::int32_t k = 0; k < count; ++k) {
    const float side = 0.1f + 0.9f * uniform(engine),
                radiance = k % 7 == 3 ? 0 : std::pow(10.0f, -3 * uniform(engine));
    lights.add<RectangleLights>({radiance, radiance, radiance}, "",
                                Vec3f{4 * uniform(engine) - 2, 4 * uniform(engine) - 2, 2}, Vec3f{0, side, 0},
                                Vec3f{side, 0, 0});
  }
  return lights;
}

class EveryLightSampler : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryLightSampler, ChoosesWithItsProbability) {
  std::mt19937 random(9);
  for (const std::int32_t count : {1, 3, 16, 1000}) {
    const Lights lights = mixed_lights(count);
    const LightSampler sampler = make_light_sampler(GetParam(), lights);
    std::vector<double> observed(static_cast<std::size_t>(count)), expected;
    double left = 0;
    int choices = 0;
    const int trials = samples / sampler.passes();
    for (int i = 0; i < trials; ++i)
      for (std::int32_t pass = 0; pass < sampler.passes(); ++pass) {
        const LightChoice<float> choice = sampler.choose<float>(receiver, std::uint32_t(random()), pass);
        ASSERT_TRUE(choice.light >= 0 && choice.light < count);
        ASSERT_EQ(choice.pmf, (sampler.pmf<float>(receiver, choice.light, 0)));
        ++observed[std::size_t(choice.light)];
        left += choice.u_left * 0x1p-32;
        ++choices;
      }
    EXPECT_NEAR(left / choices, 0.5, 5 * std::sqrt(1.0 / 12 / choices)) << "what is left over is uniform";
    for (std::int32_t light = 0; light < count; ++light)
      expected.push_back(trials * double(sampler.pmf<float>(receiver, light, 0)));
    if (sampler.passes() > 1) {
      EXPECT_EQ(observed, expected) << "each light in every sample";
      continue;
    }
    EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0) / trials, 1, 1e-5);
    if (count == 1) continue;
    const ChiSquaredTest test = chi_squared_test(observed, expected, {});
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << count << " lights: chi-squared " << test.statistic << ", " << test.degrees_of_freedom
        << " degrees of freedom";
  }
}

TEST_P(EveryLightSampler, EstimatesTheSumOverTheLights) {
  const Lights lights = mixed_lights(40);
  const LightSampler sampler = make_light_sampler(GetParam(), lights);
  std::mt19937 random(10);
  const auto irradiance = [](const LightSample<float>& sample) {
    return sample.is_there ? double(sample.radiance_over_pdf.g) * double(sample.wi.z) : 0;
  };
  RunningStatistics estimate, one_by_one;
  for (int i = 0; i < samples / 10; ++i) {
    double sum = 0;
    for (std::int32_t pass = 0; pass < sampler.passes(); ++pass) {
      const Vec2<std::uint32_t> u{std::uint32_t(random()), std::uint32_t(random())};
      const LightChoice<float> choice = sampler.choose<float>(receiver, u.x, pass);
      sum += irradiance(lights.sample<float>(choice.light, choice.pmf, receiver, {choice.u_left, u.y}, true));
    }
    estimate.add(sum);
    sum = 0;
    for (std::int32_t light = 0; light < lights.count(); ++light)
      sum += irradiance(
          lights.sample<float>(light, 1, receiver, {std::uint32_t(random()), std::uint32_t(random())}, true));
    one_by_one.add(sum);
  }
  const MeanTest test = welch_t_test(estimate, one_by_one);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << estimate.mean << " +- " << estimate.standard_error() << ", one by one " << one_by_one.mean;
}

/// A lamp of a millionth of a millionth of the sun's power may be all that lights a corner.
TEST_P(EveryLightSampler, LeavesNoLightOut) {
  Lights lights;
  for (const float radiance : {1.0f, 1e-12f, 1e-30f, 1.0f})
    lights.add<RectangleLights>({radiance, radiance, radiance}, "", Vec3f{0, 0, 2}, Vec3f{0, 1, 0},
                                Vec3f{1, 0, 0});
  const LightSampler sampler = make_light_sampler(GetParam(), lights);
  for (std::int32_t light = 0; light < lights.count(); ++light)
    EXPECT_GT((sampler.pmf<float>(receiver, light, 0)), 0) << light;
}

TEST_P(EveryLightSampler, TakesLightsWithoutPower) {
  Lights lights;
  for (int k = 0; k < 3; ++k)
    lights.add<RectangleLights>({0, 0, 0}, "", Vec3f{0, 0, 2}, Vec3f{0, 1, 0}, Vec3f{1, 0, 0});
  const LightSampler sampler = make_light_sampler(GetParam(), lights);
  const LightChoice<float> choice = sampler.choose<float>(receiver, 3u << 30, 0);
  EXPECT_TRUE(choice.light >= 0 && choice.light < 3);
  EXPECT_GT(choice.pmf, 0);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Plugin& plugin : light_sampler_plugins()) all.push_back(plugin.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Named, EveryLightSampler, ::testing::ValuesIn(names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace etendue

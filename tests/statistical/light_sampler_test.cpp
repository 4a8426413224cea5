// Every light sampler: lights are chosen with the probability that it states, what is left of the random
// number is uniform, no light of any power is left out, and the estimate has the mean of all lights' sum.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the power sampler states the pmf of the next light, or takes powers without the lights'
// areas; its least share is left out; the number left over is not stretched; `all` states the pmf 1/n; a walk
// states the pmf of the sibling; a cut states that of its neighbour, or of another tile; a walk or a cut does
// not stretch the number; the pmf within a leaf is left out; a cut takes the share at a cluster's own
// position.
#include "lightsampler/light_sampler.h"

#include "lightsampler/make_light_cut.h"
#include "lightsampler/tree_lights.h"
#include "random_lights.h"
#include "stats/chi_squared.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 300, samples = 200000;
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
        // A walk multiplies from the root down, the probability asked for is multiplied from the leaf up.
        ASSERT_NEAR((sampler.pmf<float>(receiver, choice.light, 0)) / choice.pmf, 1, 1e-5);
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
      sum += irradiance(
          lights.sample<float>(choice.light, choice.pmf, receiver, {choice.u_left, u.y}, true, choice.facet));
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

/// A sky of a sphere 100 km wide has all the power, and the lamp on the table lights the room.
TEST(LightSampler, ByPowerTakesEachAHundredthAsOftenAsAllAlike) {
  Lights lights;
  for (const float radiance : {1e12f, 1.0f, 1.0f, 0.0f})
    lights.add<RectangleLights>({radiance, radiance, radiance}, "", Vec3f{0, 0, 2}, Vec3f{0, 1, 0},
                                Vec3f{1, 0, 0});
  const LightSampler sampler = make_light_sampler("power", lights);
  EXPECT_GT((sampler.pmf<float>(receiver, 1, 0)), 0.99f * 0.01f / 4);
  EXPECT_EQ((sampler.pmf<float>(receiver, 3, 0)), 0);
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

// Facets by the light tree: by a walk for any receiver, by a cut made for others.

struct ReceiverCase {
  std::string name;
  Receiver<float> receiver;
};

std::vector<ReceiverCase> receivers_around(const LightSwarm& swarm, std::uint32_t seed, int count) {
  RandomPlaces random(seed);
  std::vector<ReceiverCase> cases;
  constexpr std::int32_t sides[]{lit_side::front, lit_side::front, lit_side::front | lit_side::back,
                                 lit_side::medium};
  for (int k = 0; k < count; ++k) {
    const Vec3f normal = random.direction();
    // Among them, around them, far from them.
    const float extent = swarm.extent * std::array{0.5f, 3.0f, 100.0f}[std::size_t(k % 3)];
    cases.push_back({fmt::format("receiver {}", k),
                     {swarm.center + random.in_cube(extent), normal, normal, sides[k % 4]}});
  }
  return cases;
}

/// Chi-squared tests of which facet is chosen; and of which jointly with what is left of the number, for the
/// facets that are chosen most: independent of the choice, and uniform.
void expect_choices_by_pmf(const TreeLights& sampler, const Lights& lights, const Receiver<float>& receiver,
                           const std::string& what) {
  std::vector<std::int32_t> first{0};
  for (std::int32_t light = 0; light < lights.count(); ++light)
    first.push_back(first.back() + lights.facet_count(light));
  const auto facets = std::size_t(first.back());
  constexpr int parts = 8;
  std::vector<double> expected, observed(facets + 1), observed_parts(facets * parts);
  double sum = 0;
  for (std::int32_t light = 0; light < lights.count(); ++light)
    for (std::int32_t facet = 0; facet < lights.facet_count(light); ++facet) {
      expected.push_back(samples * double(sampler.pmf<float>(receiver, light, facet)));
      sum += expected.back() / samples;
    }
  ASSERT_LT(sum, 1 + 1e-5) << what;
  std::mt19937 random(21);
  for (int i = 0; i < samples; ++i) {
    const LightChoice<float> choice = sampler.choose<float>(receiver, std::uint32_t(random()), 0);
    if (!(choice.pmf > 0)) {
      ++observed[facets];
      continue;
    }
    ASSERT_TRUE(choice.light >= 0 && choice.light < lights.count() && choice.facet >= 0 &&
                choice.facet < lights.facet_count(choice.light))
        << what;
    const auto at = std::size_t(first[std::size_t(choice.light)] + choice.facet);
    ASSERT_NEAR(expected[at] / samples / choice.pmf, 1, 1e-4) << what;
    ++observed[at];
    ++observed_parts[at * parts + (choice.u_left >> 29)];
  }
  expected.push_back(samples * std::max(0.0, 1 - sum));  // Nothing is chosen where nothing arrives.
  if (sum == 0) {
    EXPECT_EQ(observed[facets], samples) << what;
    return;
  }
  const ChiSquaredTest test = chi_squared_test(observed, expected, {.most_in_empty_cell = 1});
  if (facets > 1 && test.degrees_of_freedom > 0) {
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << what << ": chi-squared " << test.statistic << ", " << test.degrees_of_freedom
        << " degrees of freedom";
  }
  std::vector<double> expected_joint, observed_joint;
  for (std::size_t at = 0; at < facets; ++at)
    for (std::size_t part = 0; expected[at] > 50 * parts && part < parts; ++part) {
      expected_joint.push_back(observed[at] / parts);
      observed_joint.push_back(observed_parts[at * parts + part]);
    }
  if (expected_joint.empty()) return;
  // The number of each facet is given: one degree of freedom less for each, which makes this test careful.
  const ChiSquaredTest joint = chi_squared_test(observed_joint, expected_joint, {});
  EXPECT_FALSE(is_rejected(joint.p_value, family_level, family_size))
      << what << ", what is left over: chi-squared " << joint.statistic << ", " << joint.degrees_of_freedom
      << " degrees of freedom";
}

struct SwarmCase {
  const char* name;
  LightSwarm swarm;
  int triangles = 0;  ///< Of one more mesh.
  int beside = 0;     ///< Directional lights, which have no place.
};
constexpr SwarmCase swarm_cases[]{
    {"one", {.count = 1}},
    {"three", {.count = 3, .size = 0.5f}},
    {"forty, and three beside", {.count = 40}, 0, 3},
    {"only beside", {.count = 0}, 0, 2},
    {"a mesh among lights", {.count = 30, .size = 0.3f}, 500},
    {"at one place", {.count = 20, .extent = 0, .size = 0.3f}, 40},
    {"tiny and far off", {.count = 50, .extent = 1e-3f, .size = 1e-4f, .center = {5, -3, 8}}},
    {"leaves of four", {.count = 5, .extent = 2, .size = 0.02f}, 70000}};

Lights lights_of(const SwarmCase& c) {
  RandomPlaces random(31);
  Lights lights = random_lights(random, c.swarm);
  if (c.triangles > 0) add_triangles(lights, random, c.triangles, c.swarm, 1);
  for (int k = 0; k < c.beside; ++k) lights.add<DirectionalLights>({1, 1, 1}, "", random.direction());
  return lights;
}

class LightsByTree : public ::testing::TestWithParam<SwarmCase> {};

TEST_P(LightsByTree, AWalkChoosesFacetsWithTheirProbability) {
  const Lights lights = lights_of(GetParam());
  const TreeLights sampler(lights);
  const int receivers = GetParam().triangles > 1000 ? 2 : 6;
  for (const ReceiverCase& c : receivers_around(GetParam().swarm, 41, receivers))
    expect_choices_by_pmf(sampler, lights, c.receiver, c.name);
}

TEST_P(LightsByTree, ACutChoosesFacetsWithTheirProbability) {
  const Lights lights = lights_of(GetParam());
  const TreeLights sampler(lights);
  if (sampler.tree().is_empty()) return;
  const std::vector<ReceiverCase> cases = receivers_around(GetParam().swarm, 42, 8);
  LightCuts cuts;
  cuts.take_tiles({1, 0, 2}, nullptr, [&](std::int32_t tile) {
    std::vector<Receiver<float>> pilots;
    std::array<bool, light_cut_pilots> is_lit{};
    for (std::size_t k = 0; k < light_cut_pilots; ++k) {
      pilots.push_back(cases[k % cases.size()].receiver);
      is_lit[k] = tile > 0 && k % 3 != std::size_t(tile);  // None in one of them.
    }
    return make_light_cut<float>(
        sampler.tree(), pilots.data(), is_lit.data(),
        [](int p, const Importance<float>&) { return 1 + float(p % 4); },
        [](int p, const LightChoice<float>& choice, std::uint32_t) {
          return SeenLight<float>{p % 5 > 0, (choice.light + choice.facet) % 3 == 0};
        });
  });
  for (std::int32_t slot = 0; slot < 3; ++slot) {
    Receiver<float> receiver = receivers_around(GetParam().swarm, 43, 3)[std::size_t(slot)].receiver;
    receiver.cuts = &cuts;
    receiver.cut = slot;
    expect_choices_by_pmf(sampler, lights, receiver, fmt::format("cut {}", slot));
  }
}

INSTANTIATE_TEST_SUITE_P(Swarms, LightsByTree, ::testing::ValuesIn(swarm_cases), [](const auto& info) {
  std::string name = info.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == ','; }, '_');
  return name;
});

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Plugin& plugin : light_sampler_plugins()) all.push_back(plugin.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Named, EveryLightSampler, ::testing::ValuesIn(names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace etendue

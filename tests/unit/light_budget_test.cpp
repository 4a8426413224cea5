// A pilot takes few light samples where more gain nothing, many where they pay, and the same for any number
// of threads and samples.
//
// Statistical, with a fixed seed of the library's own: what is chosen cannot change from run to run. Seen to
// fail when: candidates cost nothing; rays of bounces cost nothing; what was tried last is taken; a change is
// taken that pays by the mean difference alone.
#include "render/light_budget.h"

#include "test_scene.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

RenderSettings settings_of(int threads, std::string_view integrator = "direct_light") {
  RenderSettings settings;
  settings.integrator = integrator_from_name(integrator);
  settings.isa = available_isas().back();
  settings.threads = threads;
  return settings;
}

std::string text_of(const BudgetPilot& pilot) {
  std::string text;
  for (const TriedBudget& each : pilot.tried)
    text += fmt::format("{} light samples of {} candidates, {} where glossy, {} BSDF samples: gain {}\n",
                        each.budget.light_samples, each.budget.candidates, each.budget.glossy_candidates,
                        each.budget.bsdf_samples, each.gain_over(pilot.tried.front()));
  return text;
}

/// A floor under what is given.
LoadedScene above_a_floor(const std::string& lights, const std::vector<SceneFile>& files, int side_px = 256) {
  return load_scene_text(camera_xml({0, -4, 1.5}, {0, 0, 0.6}, 45, side_px, "sobol") +
                             rectangle_xml({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, diffuse_xml(0.6)) + lights,
                         files);
}

/// A ball of 2 rows^2 flat parts.
std::string ball_obj(int rows) {
  std::string text;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < 2 * rows; ++j) {
      const double theta = std::numbers::pi * i / rows, phi = std::numbers::pi * j / rows;
      text += fmt::format("v {} {} {}\n", 0.35 * std::sin(theta) * std::cos(phi),
                          0.35 * std::sin(theta) * std::sin(phi), 1.2 + 0.35 * std::cos(theta));
    }
  const auto corner = [&](int i, int j) { return i * 2 * rows + j % (2 * rows) + 1; };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 2 * rows; ++j) {
      if (i > 0) text += fmt::format("f {} {} {}\n", corner(i, j), corner(i + 1, j), corner(i, j + 1));
      if (i < rows - 1)
        text += fmt::format("f {} {} {}\n", corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
    }
  return text;
}

TEST(LightBudget, IsSmallWhereLightBringsNoNoise) {
  // Stripes thinner than a pixel under a lamp that is seen whole and alike from all of them.
  std::string stripes = rectangle_xml({0, 0, 5}, {0.1, 0, 0}, {0, -0.1, 0}, light_xml(100));
  for (int i = 0; i < 150; ++i)
    stripes += rectangle_xml({0.04 * (i - 75), 0, 0.01}, {0.01, 0, 0}, {0, 3, 0}, diffuse_xml(0));
  const LoadedScene loaded = above_a_floor(stripes, {});
  const std::optional<BudgetPilot> pilot = light_budget_for(loaded.scene, settings_of(2));
  ASSERT_TRUE(pilot);
  EXPECT_EQ(pilot->tried.front().budget, (LightBudget{4, 1, 4, 1}));
  EXPECT_EQ(pilot->tried.size(), 2u) << text_of(*pilot);  // One candidate, and nothing glossy.
  EXPECT_EQ(pilot->chosen.light_samples, 1) << text_of(*pilot);
  EXPECT_GT(pilot->gain(), 1.5) << text_of(*pilot);
  const std::optional<BudgetPilot> alone = light_budget_for(loaded.scene, settings_of(1));
  ASSERT_TRUE(alone);
  for (std::size_t k = 0; k < pilot->tried.size(); ++k)
    EXPECT_EQ(alone->tried[k].differences, pilot->tried[k].differences) << k;
}

TEST(LightBudget, IsNotMisledByTheEdgeOfALamp) {
  // No light sample changes the noise of the ball's outline, which a few pixels have; all others need four.
  const LoadedScene loaded = above_a_floor(
      "<mesh type=\"obj\"><string name=\"filename\" value=\"ball.obj\"/>" + light_xml(5) + "</mesh>",
      {{"ball.obj", ball_obj(24)}});
  for (const int outline_rays : {0, 16}) {
    RenderSettings settings = settings_of(2);
    settings.integrator.rules = settings.integrator.path_rules()->with_outline_rays(outline_rays);
    const std::optional<BudgetPilot> pilot = light_budget_for(loaded.scene, settings);
    ASSERT_TRUE(pilot);
    EXPECT_EQ(pilot->tried.front().budget, (LightBudget{4, 8, 8, 1}));
    EXPECT_EQ(pilot->chosen, pilot->tried.front().budget) << text_of(*pilot);
  }
}

TEST(LightBudget, IsLargeWhereLampsAreHalfHidden) {
  std::string lamps;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 3; ++j)
      lamps +=
          rectangle_xml({-2.2 + 0.4 * i, 0.5 + 0.4 * j, 2.5}, {0.1, 0, 0}, {0, -0.1, 0}, light_xml(1 + i)) +
          rectangle_xml({-2.2 + 0.4 * i, 0.5 + 0.4 * j, 1.2 + 0.05 * i}, {0.12, 0, 0}, {0, 0.12, 0},
                        diffuse_xml(0.5));
  const LoadedScene loaded = above_a_floor(lamps, {});
  const std::optional<BudgetPilot> pilot = light_budget_for(loaded.scene, settings_of(2));
  ASSERT_TRUE(pilot);
  EXPECT_EQ(pilot->chosen.light_samples, 4) << text_of(*pilot);
  // More paths leave less noise there, but not for what they cost.
  const std::optional<BudgetPilot> paths = light_budget_for(loaded.scene, settings_of(2, "path"));
  ASSERT_TRUE(paths);
  EXPECT_EQ(paths->chosen.bsdf_samples, 1) << text_of(*paths);
}

TEST(LightBudget, HasManyCandidatesWhereLampsAreMirroredInGlossySurfaces) {
  // Lamps of equal power and different size over metal plates, each tilted so that they are seen in it.
  const Vec3d eye{0, -8.5, 2.6}, lamps{0, 1, 4.2}, x{1, 0, 0}, facing = normalize(Vec3d{0, -0.9, -1});
  std::string text = camera_xml(eye, {0, 0, 0.8}, 36, 256, "sobol") +
                     rectangle_xml({0, 0, 0}, {12, 0, 0}, {0, 12, 0}, diffuse_xml(0.25));
  struct Plate {
    double y, z, alpha;
  };
  for (const Plate& plate : {Plate{1.2, 1.6, 0.01}, {-0.6, 0.9, 0.04}, {-2.4, 0.45, 0.12}}) {
    const Vec3d middle{0, plate.y, plate.z},
        normal = normalize(normalize(eye - middle) + normalize(lamps - middle));
    text +=
        rectangle_xml(middle, x * 2.6, cross(normal, x) * 0.55,
                      fmt::format("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"{}\"/></bsdf>",
                                  plate.alpha));
  }
  double along = -2.25;
  for (const double half : {0.03, 0.09, 0.27, 0.6}) {
    text +=
        rectangle_xml(lamps + x * along, x * half, cross(facing, x) * half, light_xml(1.5 / (half * half)));
    along += 1.5;
  }
  const std::optional<BudgetPilot> pilot =
      light_budget_for(load_scene_text(text).scene, settings_of(2, "path"));
  ASSERT_TRUE(pilot);
  EXPECT_EQ(pilot->tried.front().budget, (LightBudget{1, 1, 4, 1}));
  EXPECT_EQ(pilot->chosen.glossy_candidates, 16) << text_of(*pilot);
}

TEST(LightBudget, HasSeveralPathsWhereNoiseIsOfBounces) {
  const std::string wall = diffuse_xml(0.6),
                    room = rectangle_xml({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, wall) +
                           rectangle_xml({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, wall) +
                           rectangle_xml({0, 1, 1}, {1, 0, 0}, {0, 0, 1}, wall) +
                           rectangle_xml({-1, 0, 1}, {0, 1, 0}, {0, 0, 1}, wall) +
                           rectangle_xml({1, 0, 1}, {0, 0, 1}, {0, 1, 0}, wall) +
                           rectangle_xml({0, 0, 1.99}, {0.3, 0, 0}, {0, -0.3, 0}, light_xml(10));
  const LoadedScene loaded = load_scene_text(camera_xml({0, -3.8, 1}, {0, 0, 1}, 38, 256, "sobol") + room);
  const std::optional<BudgetPilot> pilot = light_budget_for(loaded.scene, settings_of(2, "path"));
  ASSERT_TRUE(pilot);
  EXPECT_GT(pilot->chosen.bsdf_samples, 1) << text_of(*pilot);
  // Two paths take nearly twice the time of one: bounces are most of it.
  const auto with_paths = [&](int count) {
    return *std::ranges::find(pilot->tried, count,
                              [](const TriedBudget& tried) { return tried.budget.bsdf_samples; });
  };
  EXPECT_GT(with_paths(2).seconds, 1.7 * with_paths(1).seconds);
  EXPECT_LT(with_paths(2).seconds, 2 * with_paths(1).seconds);
  // Where only one vertex counts there is nothing to share a camera ray.
  const std::optional<BudgetPilot> direct = light_budget_for(loaded.scene, settings_of(2));
  ASSERT_TRUE(direct);
  for (const TriedBudget& tried : direct->tried) EXPECT_EQ(tried.budget.bsdf_samples, 1);
}

TEST(LightBudget, TakesAChangeThatPaysByBothMeasures) {
  const TriedBudget usual{{}, std::vector<double>(100, 1.0), 1};
  TriedBudget even = usual, few_worse = usual;
  even.differences.assign(100, 0.5);
  EXPECT_DOUBLE_EQ(even.gain_over(usual), 4);
  EXPECT_DOUBLE_EQ(usual.gain_over(even), 0.25);
  even.seconds = 4;
  EXPECT_DOUBLE_EQ(even.gain_over(usual), 1);
  // Less in most pixels, but more by square; and one pixel that is far worse is not asked.
  few_worse.differences.assign(100, 0.5);
  std::fill_n(few_worse.differences.begin(), 10, 4.0);
  EXPECT_LT(few_worse.gain_over(usual), 1);
  few_worse.differences.assign(100, 0.5);
  few_worse.differences[7] = 4;
  EXPECT_GT(few_worse.gain_over(usual), 3);
}

TEST(LightBudget, IsLeftAloneWhereThereIsNoChoice) {
  const std::string lamp = rectangle_xml({0, 0, 2}, {0.5, 0, 0}, {0, -0.5, 0}, light_xml(1));
  EXPECT_TRUE(light_budget_for(above_a_floor(lamp, {}).scene, settings_of(1)));
  EXPECT_FALSE(light_budget_for(above_a_floor(lamp, {}, 128).scene, settings_of(1)));
  RenderSettings settings = settings_of(1);
  settings.integrator = with_candidates(settings.integrator, 2);
  EXPECT_FALSE(light_budget_for(above_a_floor(lamp, {}).scene, settings));
  settings.integrator = integrator_from_name("light");
  EXPECT_FALSE(light_budget_for(above_a_floor(lamp, {}).scene, settings));
  settings.integrator = integrator_from_name("normals");
  EXPECT_FALSE(light_budget_for(above_a_floor(lamp, {}).scene, settings));
}

}  // namespace
}  // namespace etendue

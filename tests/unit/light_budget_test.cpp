// A pilot takes few light samples where more gain nothing, many where they pay, and the same for any number
// of threads and samples.
//
// Statistical, with a fixed seed of the library's own: what is chosen cannot change from run to run. Seen to
// fail when: candidates cost nothing.
#include "render/light_budget.h"

#include "test_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

RenderSettings settings_of(int threads) {
  RenderSettings settings;
  settings.integrator = integrator_from_name("direct_light");
  settings.isa = available_isas().back();
  settings.threads = threads;
  return settings;
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

TEST(LightBudget, IsSmallForALampThatIsSeenWhole) {
  const LoadedScene loaded = above_a_floor(
      "<mesh type=\"obj\"><string name=\"filename\" value=\"ball.obj\"/>" + light_xml(5) + "</mesh>",
      {{"ball.obj", ball_obj(24)}});
  const std::optional<BudgetPilot> pilot = light_budget_for(loaded.scene, settings_of(2));
  ASSERT_TRUE(pilot);
  EXPECT_EQ(pilot->tried.front().budget, (LightBudget{4, 8}));
  EXPECT_EQ(pilot->tried.size(), 4u);
  EXPECT_EQ(pilot->chosen.light_samples, 1);
  const std::optional<BudgetPilot> alone = light_budget_for(loaded.scene, settings_of(1));
  ASSERT_TRUE(alone);
  for (std::size_t k = 0; k < pilot->tried.size(); ++k)
    EXPECT_EQ(alone->tried[k].error, pilot->tried[k].error) << k;
}

TEST(LightBudget, IsLargeWhereLampsAreHalfHidden) {
  std::string lamps;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 3; ++j)
      lamps +=
          rectangle_xml({-2.2 + 0.4 * i, 0.5 + 0.4 * j, 2.5}, {0.1, 0, 0}, {0, -0.1, 0}, light_xml(1 + i)) +
          rectangle_xml({-2.2 + 0.4 * i, 0.5 + 0.4 * j, 1.2 + 0.05 * i}, {0.12, 0, 0}, {0, 0.12, 0},
                        diffuse_xml(0.5));
  const std::optional<BudgetPilot> pilot = light_budget_for(above_a_floor(lamps, {}).scene, settings_of(2));
  ASSERT_TRUE(pilot);
  EXPECT_EQ(pilot->chosen.light_samples, 4);
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

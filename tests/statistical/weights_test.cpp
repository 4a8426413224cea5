// Compensated and optimal weights keep the mean that power has, by Welch's t-test of blocks of pixels; and
// the pilot of optimal weights leaves out a coefficient that gains less than it costs.
//
// False-alarm rate of this file: 1e-4 (Sidak over all its t-tests), fixed seeds.
// Seen to fail when: the control variate of light samples is left out; that of BSDF samples has the wrong
// sign; compensated weights of hits have half the density of light samples; the density of an environment
// map's hits is that of the map without compensation; the pilot thinks that a control variate takes no time.
#include "film/block_mean.h"
#include "image/image_file.h"
#include "render/optimal_weights.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr double family_level = 1e-4;
constexpr int side_px = 32, block_px = 8, channels = 3, cases = 6;
constexpr int family_size = cases * channels * (side_px / block_px) * (side_px / block_px);

/// A glossy floor and a ball under two lamps, one of them near the floor.
LoadedScene lamps_scene(int side = side_px) {
  return load_scene_text(
      camera_xml({0, -4, 2}, {0, 0, 0.4}, 40, side, "sobol") +
      rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, phong_xml(0.3, 0.4, 20)) +
      sphere_xml({-0.7, 0, 0.6}, 0.6, phong_xml(0.2, 0.6, 200)) +
      rectangle_xml({0.6, 0.9, 0.7}, {0.5, 0, 0.1}, {0, -0.1, -0.4}, light_xml(3) + diffuse_xml(0.2)) +
      rectangle_xml({0, -0.5, 3}, {1, 0, 0}, {0, -1, 0}, light_xml(1) + diffuse_xml(0)));
}

/// The same things under an environment map, most of which is darker than its mean.
LoadedScene map_scene() {
  const test::TemporaryFolder folder;
  Image map{8, 4, {{"B", {}}, {"G", {}}, {"R", {}}}, {}};
  for (std::size_t c = 0; c < 3; ++c)
    for (int i = 0; i < 32; ++i) map.channels[c].values.push_back(0.3f + 0.1f * float(c) + (i == 11 ? 6 : 0));
  write_exr(folder.path() / "map.exr", map);
  return load_scene_text(camera_xml({0, -4, 2}, {0, 0, 0.4}, 40, side_px, "sobol") +
                         rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, diffuse_xml(0.5)) +
                         sphere_xml({-0.7, 0, 0.6}, 0.6, phong_xml(0.2, 0.6, 50)) +
                         "<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
                         (folder.path() / "map.exr").string() + "\"/></emitter>");
}

Film film_of(const Scene& scene, const char* integrator, Heuristic heuristic, std::uint64_t seed,
             const Colorf& alpha = {0, 0, 0}) {
  RenderSettings settings = render_settings(integrator, 512, 16, seed, heuristic);
  settings.integrator = with_alpha(settled(settings.integrator, scene.lights), alpha);
  RenderResult result = render(scene, settings);
  EXPECT_EQ(result.invalid.count(), 0) << integrator;
  return std::move(result.film);
}

void expect_equal_means(const Film& film, const Film& other, const std::string& what) {
  for (int y = 0; y < side_px; y += block_px)
    for (int x = 0; x < side_px; x += block_px)
      for (const Channel64 channel : channels64) {
        const RunningStatistics a = block_mean(film, x, y, block_px, channel),
                                b = block_mean(other, x, y, block_px, channel);
        const MeanTest test = welch_t_test(a, b);
        EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
            << what << ", block at " << x << ", " << y << ": " << a.mean << " +- " << a.standard_error()
            << ", " << b.mean << " +- " << b.standard_error() << ", p = " << test.p_value;
      }
}

TEST(Weights, CompensatedOnesKeepTheMean) {
  const LoadedScene lamps = lamps_scene();
  for (const char* integrator : {"mis", "path_mis"})
    expect_equal_means(film_of(lamps.scene, integrator, Heuristic::compensated, 1),
                       film_of(lamps.scene, integrator, Heuristic::power, 2), integrator);
  LoadedScene map = map_scene();
  const Film power = film_of(map.scene, "mis", Heuristic::power, 3);
  const RenderSettings settings = render_settings("mis", 16, 16, 0, Heuristic::compensated);
  ASSERT_TRUE(compensates_environments(settings.integrator));
  map.scene.lights.compensate_environments();
  expect_equal_means(film_of(map.scene, "mis", Heuristic::compensated, 4), power, "mis, environment map");
}

/// Which light samples alone must find, they must not leave out.
TEST(Weights, EnvironmentsAreCompensatedWhereBsdfSamplesFindThemEverywhere) {
  for (const char* integrator : {"direct_light", "path"})
    EXPECT_FALSE(
        compensates_environments(render_settings(integrator, 16, 16, 0, Heuristic::compensated).integrator));
  EXPECT_FALSE(compensates_environments(render_settings("mis", 16, 16, 0, Heuristic::power).integrator));
  EXPECT_FALSE(compensates_environments(integrator_from_name("light")));
}

TEST(Weights, OptimalOnesKeepTheMeanWhateverTheCoefficient) {
  const LoadedScene lamps = lamps_scene();
  for (const char* integrator : {"mis", "path_mis", "direct_light"})
    expect_equal_means(film_of(lamps.scene, integrator, Heuristic::optimal, 5, {0.5f, -0.3f, 1}),
                       film_of(lamps.scene, integrator, Heuristic::power, 6), integrator);
}

/// Beside a cube that shines, close above a floor: most light samples lie on sides that face away, and those
/// of the BSDF often meet it.
LoadedScene cube_lamp_scene() {
  std::string sides;
  const auto add_side = [&](const Vec3d& normal, const Vec3d& x, const Vec3d& y) {
    constexpr double half = 0.5;
    sides +=
        rectangle_xml(Vec3d{0, 0, 0.6} + half * normal, half * x, half * y, light_xml(1) + diffuse_xml(0));
  };
  const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  add_side(x, y, z), add_side(-x, z, y);
  add_side(y, z, x), add_side(-y, x, z);
  add_side(z, x, y), add_side(-z, y, x);
  return load_scene_text(camera_xml({0, -4, 2}, {-1.4, 0, 0}, 14, 256, "sobol") +
                         rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, diffuse_xml(0.6)) + sides);
}

double total_variance(const Scene& scene, const Colorf& alpha) {
  RenderSettings settings = render_settings("mis", 64, 16, 7, Heuristic::optimal);
  settings.integrator = with_alpha(settings.integrator, alpha);
  const RenderResult result = render(scene, settings);
  double sum = 0;
  for (int y = 0; y < result.film.height(); ++y)
    for (int x = 0; x < result.film.width(); ++x) sum += result.film.at(x, y).m2.g;
  return sum;
}

TEST(Weights, APilotLeavesOutACoefficientThatGainsLessThanItCosts) {
  const LoadedScene loaded = cube_lamp_scene();
  RenderSettings settings = render_settings("mis", 16, 16, 0, Heuristic::optimal);
  ASSERT_TRUE(needs_weight_pilot(loaded.scene, settings));
  const std::optional<WeightPilot> pilot = optimal_alpha_for(loaded.scene, settings);
  ASSERT_TRUE(pilot);
  EXPECT_EQ(pilot->alpha, (Colorf{0, 0, 0}));
  EXPECT_EQ(pilot->variance_ratio, 1);
  const double gain =
      total_variance(loaded.scene, {-0.05f, -0.05f, -0.05f}) / total_variance(loaded.scene, {0, 0, 0});
  EXPECT_LT(gain, 0.99);
  EXPECT_GT(gain, 1 / 1.04);
  settings.threads = 1;
  EXPECT_EQ(optimal_alpha_for(loaded.scene, settings)->alpha, pilot->alpha);
}

TEST(Weights, ThereIsNoPilotWhereItCannotTell) {
  const LoadedScene lamps = lamps_scene(256);
  EXPECT_FALSE(
      needs_weight_pilot(lamps_scene().scene, render_settings("mis", 16, 16, 0, Heuristic::optimal)));
  EXPECT_FALSE(needs_weight_pilot(lamps.scene, render_settings("mis", 16, 16, 0, Heuristic::power)));
  EXPECT_FALSE(needs_weight_pilot(lamps.scene, render_settings("light", 16, 16, 0)));
}

}  // namespace
}  // namespace etendue

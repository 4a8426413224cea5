// Images whose number of samples a pilot has told are unbiased; those that stop when their own interval is
// small are not.
//
// False-alarm rate of this file: 3e-5 (normal approximation), fixed seeds. Seen to fail: the naive rule,
// which must each time.
#include "render/pilot.h"

#include "film/pixel_intervals.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

constexpr ErrorGoal goal{.relative = 0.35, .share = 1, .confidence = 0.95};
constexpr int most_samples = 256;

/// One pixel that sees a point, and a lamp that one BSDF sample in eight meets.
struct SeldomLit {
  Vec3d center{0, 0, 1}, half_u{0.33, 0, 0}, half_v{0, -0.33, 0};
  LoadedScene loaded = load_scene_text(camera_xml({1.5, -2.5, 2}, {0, 0, 0}, 0.001, 1, "independent") +
                                       rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, diffuse_xml(0.6)) +
                                       rectangle_xml(center, half_u, half_v, light_xml(3)));
  double exact = 0.6 / std::numbers::pi *
                 polygon_irradiance(rectangle_corners(center, half_u, half_v), 3, {0, 0, 0}, {0, 0, 1});

  RenderSettings settings(int samples, std::uint64_t seed) const {
    return render_settings("direct", samples, 8, seed);
  }
  double value(int samples, std::uint64_t seed) const {
    return render(loaded.scene, settings(samples, seed)).film.at(0, 0).mean.g;
  }
};

double share_reached(const RenderResult& result, const ErrorGoal& of) {
  return share_within(result.film, pixel_intervals(result.film, result.luminances, of.confidence), of);
}

TEST(Pilot, LeavesTheImageUnbiasedWhereTheNaiveRuleIsNot) {
  const SeldomLit scene;
  RunningStatistics by_pilot, naive;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Pilot pilot = samples_for_error(scene.loaded.scene, scene.settings(16, seed), goal, most_samples);
    ASSERT_GE(pilot.samples_per_pixel, 16);
    ASSERT_LE(pilot.samples_per_pixel, most_samples);
    by_pilot.add(scene.value(pilot.samples_per_pixel, seed));
    int samples = 16;
    while (samples < most_samples &&
           share_reached(render(scene.loaded.scene, scene.settings(samples, seed)), goal) < 1)
      samples *= 2;
    naive.add(scene.value(samples, seed));
  }
  const MeanTest of_pilot = t_test(by_pilot, scene.exact), of_naive = t_test(naive, scene.exact);
  EXPECT_FALSE(is_rejected(of_pilot.p_value, 1e-5, 1)) << by_pilot.mean << " for " << scene.exact;
  EXPECT_TRUE(is_rejected(of_naive.p_value, 1e-5, 1)) << naive.mean << " for " << scene.exact;
}

TEST(Pilot, AsksForAsManySamplesAsTheGoalTakes) {
  const SeldomLit scene;
  const ErrorGoal narrow{.relative = 0.03, .share = 1, .confidence = 0.95};
  RunningStatistics values;  // Of 16 samples.
  for (std::uint64_t seed = 0; seed < 2000; ++seed) values.add(scene.value(16, seed));
  const double needed = 16 * values.variance() * std::pow(1.96 / (narrow.relative * scene.exact), 2);
  // Over what is allowed. Its spread is 0.13, over 40 seeds 0.02; one pixel tells its variance, and how fast
  // it falls, so badly that the mean is 1.2.
  RunningStatistics error;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Pilot pilot = samples_for_error(scene.loaded.scene, scene.settings(16, seed), narrow, 1 << 20);
    error.add(std::sqrt(needed / pilot.samples_per_pixel));
  }
  EXPECT_NEAR(error.mean, 1, 0.3);
}

/// A lamp just above the floor, so that few pixels hold most of the variance.
struct LampOverFloor {
  LoadedScene loaded = load_scene_text(camera_xml({0, -1, 6}, {0, 0, 0}, 40, 12, "independent") +
                                       rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, diffuse_xml(0.6)) +
                                       rectangle_xml({-1, 0, 0.3}, {0.2, 0, 0}, {0, -0.2, 0}, light_xml(3)) +
                                       sphere_xml({1, 1, 0.5}, 0.4, diffuse_xml(0.5)));
  /// Samples by solid angle vary so much less that their error does not count.
  Film exact = render(loaded.scene, render_settings("direct_light", 1 << 13, 8, 1000)).film;

  RenderSettings settings(int samples, std::uint64_t seed) const {
    return render_settings("light", samples, 8, seed);
  }
};

TEST(AllocationPilot, LeavesTheImageUnbiasedAndItsVarianceSmaller) {
  const LampOverFloor scene;
  const LoadedScene& loaded = scene.loaded;
  const Film& exact = scene.exact;
  RunningStatistics shared, errors_shared, errors_alike;
  const auto squared_error = [&](const Film& film) {
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) sum += std::pow(film.at(x, y).mean.g - exact.at(x, y).mean.g, 2);
    return sum;
  };
  std::int64_t samples = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RenderSettings settings = scene.settings(64, seed);
    const AllocationPilot pilot = allocation_for(loaded.scene, settings);
    settings.allocation = pilot.allocation;
    const RenderResult result = render(loaded.scene, settings);
    samples += result.counts.samples + std::int64_t(12 * 12) * pilot.samples_per_pixel;
    shared.add(result.film.mean().g);
    errors_shared.add(squared_error(result.film));
    errors_alike.add(squared_error(render(loaded.scene, scene.settings(64, seed)).film));
  }
  EXPECT_LE(samples, std::int64_t(400) * 12 * 12 * 64);
  const MeanTest test = t_test(shared, exact.mean().g);
  EXPECT_FALSE(is_rejected(test.p_value, 1e-5, 1)) << shared.mean << " for " << exact.mean().g;
  EXPECT_LT(errors_shared.mean, 0.5 * errors_alike.mean);
}

TEST(ErrorAllocation, LeavesTheImageUnbiasedAndReachesTheGoalWithFewerSamples) {
  const LampOverFloor scene;
  const ErrorGoal of_most{.relative = 0.1, .share = 0.97, .confidence = 0.95};
  RunningStatistics means;
  double share_reached = 0, samples = 0, samples_of_all = 0;
  constexpr int pilots = 10, images = 40;
  for (std::uint64_t seed = 0; seed < pilots; ++seed) {
    RenderSettings settings = scene.settings(16, seed);
    const ErrorAllocation found = allocation_for_error(scene.loaded.scene, settings, of_most, 1 << 16);
    samples += found.pilot.samples_per_pixel;
    samples_of_all += samples_for_error(scene.loaded.scene, settings, of_most, 1 << 16).samples_per_pixel;
    settings.replicates = found.replicates;
    settings.allocation = found.allocation;
    settings.samples_per_pixel = found.pilot.samples_per_pixel;
    std::vector<RunningStatistics> pixels(scene.exact.width() * scene.exact.height());
    for (int image = 0; image < images; ++image) {
      settings.seed = seed + std::uint64_t(image) * 1000;  // The first is the pilots' own seed.
      const Film film = render(scene.loaded.scene, settings).film;
      means.add(film.mean().g);
      for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i].add(film.at(int(i) % film.width(), int(i) / film.width()).mean.g);
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double truth = scene.exact.at(int(i) % scene.exact.width(), int(i) / scene.exact.width()).mean.g;
      const double allowed = of_most.relative * std::max(truth, 0.01 * scene.exact.mean().g);
      share_reached += 1.96 * std::sqrt(pixels[i].variance()) <= allowed;
    }
  }
  share_reached /= double(pilots * scene.exact.width() * scene.exact.height());
  const MeanTest test = t_test(means, scene.exact.mean().g);
  EXPECT_FALSE(is_rejected(test.p_value, 1e-5, 1)) << means.mean << " for " << scene.exact.mean().g;
  // The spread of errors that 40 images tell blurs the end of the share.
  EXPECT_NEAR(share_reached, of_most.share, 0.04);
  EXPECT_LT(samples, 0.7 * samples_of_all) << samples << " and " << samples_of_all;
}

}  // namespace
}  // namespace etendue

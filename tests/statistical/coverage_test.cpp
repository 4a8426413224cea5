// A pixel's Student-t interval over its replicates contains the exact value as often as it says.
//
// False-alarm rate of this file: 1e-5 (Sidak over its binomial tests, normal approximation), fixed seeds.
// Seen to fail when: every two replicates share a stream.
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(Coverage, StudentIntervalsOverReplicatesHoldTheExactValueInTheirShareOfPixels) {
  constexpr int side_px = 64, tests = 2 * 2 * 2;
  const Vec3d center{-0.4, 0.5, 1}, half_u{0.8, 0.1, 0.2}, half_v{0.1, -0.7, 0.1};
  const double exact = 0.6 / std::numbers::pi *
                       polygon_irradiance(rectangle_corners(center, half_u, half_v), 3, {0, 0, 0}, {0, 0, 1});
  for (const char* sampler : {"independent", "sobol"}) {
    // Every pixel sees the same point: each is one more trial.
    const LoadedScene loaded =
        load_scene_text(camera_xml({1.5, -2.5, 2}, {0, 0, 0}, 0.001, side_px, sampler) +
                        rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, diffuse_xml(0.6)) +
                        rectangle_xml(center, half_u, half_v, light_xml(3)));
    for (const std::string kind : {"light", "direct"})
      for (const int replicates : {4, 16}) {
        // BSDF sampling counts hits: over few Sobol samples the counts take so few values that 4 of them are
        // far from normal (64 samples: 92 % are covered).
        const int samples = kind == "direct" ? 512 : 64;
        const Film film =
            render(loaded.scene, render_settings(kind, samples * replicates, replicates, 31)).film;
        int covered = 0;
        for (int y = 0; y < side_px; ++y)
          for (int x = 0; x < side_px; ++x) {
            const PixelStatistics& pixel = film.at(x, y);
            const Interval interval = student_t_interval({pixel.count, pixel.mean.g, pixel.m2.g}, 0.95);
            covered += interval.lower <= exact && exact <= interval.upper;
          }
        const double trials = side_px * side_px, share = covered / trials;
        const MeanTest test = z_test(share, 0.95, std::sqrt(0.95 * 0.05 / trials));
        EXPECT_FALSE(is_rejected(test.p_value, 1e-5, tests))
            << sampler << ", " << kind << ", " << replicates << " replicates: " << share
            << " of the intervals";
      }
  }
}

}  // namespace
}  // namespace etendue

// Phase functions: samples follow their density, which is normalised, and turn by the mean cosine g.
//
// False-alarm rate of this file: 1e-5 (Sidak over all its tests), fixed seeds.
// Seen to fail when the density has the wrong sign of g.
#include "medium/phase.h"

#include "sphere_cells.h"
#include "stats/chi_squared.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 40;
constexpr int samples = 400000;
constexpr float asymmetries[]{0, 5e-4f, -2e-3f, 0.3f, 0.8f, -0.6f, 0.95f};

class HenyeyGreensteinPhase : public testing::TestWithParam<float> {};

TEST_P(HenyeyGreensteinPhase, SamplesFollowTheDensityAndTurnByG) {
  const float g = GetParam();
  const HenyeyGreenstein phase{g};
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f wo{0, 0, side};
    // Rows of equal probability: where the cosine to the way on has the distribution function h / rows
    // (Henyey and Greenstein's is invertible; in double and by another formula than the code's).
    constexpr int rows = 20, columns = 12;
    const double a = g, sign = -side;  // The way on is -wo.
    const auto below = [=](double cosine) {
      if (std::abs(a) < 1e-2) return (cosine + 1) / 2 + a * 0.75 * (cosine * cosine - 1);
      return (1 - a * a) / (2 * a) * (1 / std::sqrt(1 + a * a - 2 * a * cosine) - 1 / (1 + a));
    };
    const SphereCells cells(
        rows, columns, [=](double z) { return sign > 0 ? rows * below(z) : rows * (1 - below(-z)); },
        [=](double h) {
          double low = -1, high = 1;
          for (int i = 0; i < 60; ++i) {
            const double z = 0.5 * (low + high);
            ((sign > 0 ? rows * below(z) : rows * (1 - below(-z))) < h ? low : high) = z;
          }
          return 0.5 * (low + high);
        });
    std::vector<double> expected = cells.integrals(
        [&](const Vec3<double>& wi) {
          return double(phase.pdf_solid_angle(wo, Vec3f{float(wi.x), float(wi.y), float(wi.z)}));
        },
        8);
    double total = 0;
    for (double& e : expected) {
      total += e;
      e *= samples;
    }
    EXPECT_NEAR(total, 1, 1e-3);

    std::mt19937 engine(7);
    const auto unit = [&] { return float(engine() >> 8) * 0x1p-24f; };
    std::vector<double> observed(cells.size());
    RunningStatistics cosine;
    for (int i = 0; i < samples; ++i) {
      const float x = unit();
      const BsdfSample<float> sample = phase.sample(wo, Vec2f{x, unit()});
      const Vec3<double> wi{sample.wi_local.x, sample.wi_local.y, sample.wi_local.z};
      ASSERT_NEAR(length(wi), 1, 1e-5);
      ASSERT_EQ(sample.pdf_solid_angle, phase.pdf_solid_angle(wo, sample.wi_local));
      ASSERT_EQ(phase.eval(wo, sample.wi_local).g, sample.pdf_solid_angle);
      ASSERT_EQ(sample.weight.g, 1);
      ++observed[cells.cell_of(wi)];
      cosine.add(-side * wi.z);
    }
    const ChiSquaredTest counts = chi_squared_test(observed, expected);
    EXPECT_FALSE(is_rejected(counts.p_value, family_level, family_size))
        << "g = " << g << ", wo " << side << ": chi-squared " << counts.statistic << " with "
        << counts.degrees_of_freedom;
    const MeanTest mean = t_test(cosine, a);
    EXPECT_FALSE(is_rejected(mean.p_value, family_level, family_size))
        << "g = " << g << ", wo " << side << ": mean cosine " << cosine.mean << " +- "
        << cosine.standard_error();
  }
}

INSTANTIATE_TEST_SUITE_P(OfG, HenyeyGreensteinPhase, testing::ValuesIn(asymmetries),
                         [](const auto& info) { return "number" + std::to_string(info.index); });

}  // namespace
}  // namespace etendue

// Pixel filters: sampled offsets follow the filter's own density.
//
// False-alarm rate of this file: 1e-5 (Sidak), fixed seeds.
// Seen to fail when: the table is looked up by 2 u in place of its square root; it has evenly spaced
// quantiles; the Gaussian keeps its edge value; tent's cumulative is wrong on the left.
#include "film/filter.h"

#include "stats/chi_squared.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 30;

struct Case {
  const char* name;
  PixelFilter filter;
  double radius_px;
  std::function<double(double)> density;  ///< Not normalised.
};

std::vector<Case> cases() {
  const auto gaussian = [](double radius, double stddev) {
    return [=](double x) {
      return std::exp(-x * x / (2 * stddev * stddev)) - std::exp(-radius * radius / (2 * stddev * stddev));
    };
  };
  return {{"box", PixelFilter::box(), 0.5, [](double) { return 1.0; }},
          {"wide box", PixelFilter::box(1.5), 1.5, [](double) { return 1.0; }},
          {"tent", PixelFilter::tent(), 1, [](double x) { return 1 - std::abs(x); }},
          {"gaussian", PixelFilter::gaussian(), 2, gaussian(2, 0.5)},
          {"narrow gaussian", PixelFilter::gaussian(1, 0.2), 1, gaussian(1, 0.2)},
          {"wide gaussian", PixelFilter::gaussian(1.5, 1), 1.5, gaussian(1.5, 1)}};
}

/// The integral of f over [from, to] by the midpoint rule.
double integral(const std::function<double(double)>& f, double from, double to) {
  constexpr int steps = 2000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(from + (to - from) * (i + 0.5) / steps);
  return sum * (to - from) / steps;
}

TEST(PixelFilter, OffsetsFollowTheDensity) {
  std::mt19937 random(3);
  for (const Case& c : cases()) {
    constexpr int cells = 64, n = 200000;
    std::vector<double> observed(cells), expected;
    RunningStatistics offsets, squares;
    for (int i = 0; i < n; ++i) {
      const float x = c.filter.sample_offset_px(float(random() >> 8) * 0x1p-24f);
      ASSERT_LE(std::abs(x), float(c.radius_px));
      ++observed[std::min(std::size_t((x / c.radius_px + 1) * 0.5 * cells), std::size_t(cells - 1))];
      offsets.add(x);
      squares.add(double(x) * x);
    }
    const double total = integral(c.density, -c.radius_px, c.radius_px);
    for (int i = 0; i < cells; ++i)
      expected.push_back(n / total *
                         integral(c.density, c.radius_px * (2.0 * i / cells - 1),
                                  c.radius_px * (2.0 * (i + 1) / cells - 1)));
    const ChiSquaredTest test = chi_squared_test(observed, expected);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << c.name << ": chi-squared " << test.statistic;
    const double variance =
        integral([&](double x) { return x * x * c.density(x); }, -c.radius_px, c.radius_px) / total;
    EXPECT_FALSE(is_rejected(t_test(offsets, 0).p_value, family_level, family_size))
        << c.name << ": mean " << offsets.mean;
    EXPECT_FALSE(is_rejected(t_test(squares, variance).p_value, family_level, family_size))
        << c.name << ": variance " << squares.mean << ", exact " << variance;
  }
}

TEST(PixelFilter, IsSymmetricAndMonotonic) {
  for (const Case& c : cases()) {
    EXPECT_EQ(c.filter.radius_px(), float(c.radius_px));
    EXPECT_EQ(c.filter.sample_offset_px(0.0f), float(-c.radius_px));
    float last = -float(c.radius_px);
    for (int i = 1; i < 4096; ++i) {
      const float u = float(i) / 4096, x = c.filter.sample_offset_px(u);
      EXPECT_GE(x, last);
      EXPECT_NEAR(x, -c.filter.sample_offset_px(1 - u), 1e-6) << c.name << " at " << u;
      last = x;
    }
  }
}

}  // namespace
}  // namespace etendue

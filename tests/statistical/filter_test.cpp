// Pixel filters: sampled offsets follow the filter's own density.
//
// False-alarm rate of this file: 1e-5 (Sidak), fixed seeds.
// Seen to fail when: the table is looked up by 2 u in place of its square root; it has evenly spaced
// quantiles; the Gaussian keeps its edge value; tent's cumulative is wrong on the left. Of mitchell: the
// weight lacks its square; all weights are positive; the sign changes at s = 1; B and C are exchanged.
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
constexpr int family_size = 100;  // At least as many tests as are made below.

struct Case {
  const char* name;
  PixelFilter filter;
  double radius_px;
  std::function<double(double)> density;  ///< Not normalised, signed.
};

/// Mitchell and Netravali 1988, eq. 8.
double mitchell_netravali(double s, double b, double c) {
  if (s < 1) return ((12 - 9 * b - 6 * c) * s * s * s + (-18 + 12 * b + 6 * c) * s * s + 6 - 2 * b) / 6;
  return ((-b - 6 * c) * s * s * s + (6 * b + 30 * c) * s * s + (-12 * b - 48 * c) * s + 8 * b + 24 * c) / 6;
}

std::vector<Case> cases() {
  const auto mitchell = [](double radius, double b, double c) {
    return [=](double x) { return mitchell_netravali(2 * std::abs(x) / radius, b, c); };
  };
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
          {"wide gaussian", PixelFilter::gaussian(1.5, 1), 1.5, gaussian(1.5, 1)},
          {"B-spline", PixelFilter::mitchell(2, 1, 0), 2, mitchell(2, 1, 0)},
          {"mitchell", PixelFilter::mitchell(), 2, mitchell(2, 1.0 / 3, 1.0 / 3)},
          {"Catmull-Rom", PixelFilter::mitchell(2, 0, 0.5), 2, mitchell(2, 0, 0.5)},
          {"wide mitchell", PixelFilter::mitchell(3, 0.5, 0.25), 3, mitchell(3, 0.5, 0.25)}};
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
    const auto density = [&](double x) { return std::abs(c.density(x)); };
    const double total = integral(density, -c.radius_px, c.radius_px);
    for (int i = 0; i < cells; ++i)
      expected.push_back(
          n / total *
          integral(density, c.radius_px * (2.0 * i / cells - 1), c.radius_px * (2.0 * (i + 1) / cells - 1)));
    const ChiSquaredTest test = chi_squared_test(observed, expected);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << c.name << ": chi-squared " << test.statistic;
    const double variance =
        integral([&](double x) { return x * x * density(x); }, -c.radius_px, c.radius_px) / total;
    EXPECT_FALSE(is_rejected(t_test(offsets, 0).p_value, family_level, family_size))
        << c.name << ": mean " << offsets.mean;
    EXPECT_FALSE(is_rejected(t_test(squares, variance).p_value, family_level, family_size))
        << c.name << ": variance " << squares.mean << ", exact " << variance;
  }
}

/// The mean of weight g(x, y) over samples should be the integral of f g over that of f.
struct Integrand {
  const char* name;
  std::function<double(double, double)> g;
};

TEST(PixelFilter, WeightedSamplesConvolveWithTheFilterWithoutBias) {
  const Integrand integrands[]{{"constant", [](double, double) { return 1.0; }},
                               {"edge", [](double x, double) { return x > 0.3 ? 1.0 : 0.0; }},
                               {"corner", [](double x, double y) { return x > 1.2 && y < -0.1 ? 1.0 : 0.0; }},
                               {"ramp", [](double x, double y) { return 2 + x + 0.5 * y; }},
                               {"parabola", [](double x, double) { return x * x; }}};
  std::mt19937 random(4);
  for (const Case& c : cases()) {
    constexpr int n = 1 << 20, steps = 1200;
    std::vector<RunningStatistics> estimates(std::size(integrands));
    for (int i = 0; i < n; ++i) {
      const float u_x = float(random() >> 8) * 0x1p-24f, u_y = float(random() >> 8) * 0x1p-24f;
      const double weight = c.filter.sample_weight(u_x, u_y);
      EXPECT_TRUE(c.filter.is_signed() || weight == 1) << c.name;
      const double x = c.filter.sample_offset_px(u_x), y = c.filter.sample_offset_px(u_y);
      for (std::size_t k = 0; k < std::size(integrands); ++k)
        estimates[k].add(weight * integrands[k].g(x, y));
    }
    std::vector<double> exact(std::size(integrands));
    double total = 0;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double x = c.radius_px * (2 * (i + 0.5) / steps - 1),
                     y = c.radius_px * (2 * (j + 0.5) / steps - 1);
        const double f = c.density(x) * c.density(y);
        total += f;
        for (std::size_t k = 0; k < std::size(integrands); ++k) exact[k] += f * integrands[k].g(x, y);
      }
    for (std::size_t k = 0; k < std::size(integrands); ++k) {
      // A constant under a filter of weight 1 does not vary; the floor is float's rounding of the sums.
      const MeanTest test = t_test(estimates[k], exact[k] / total, 1e-10);
      EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
          << c.name << ", " << integrands[k].name << ": " << estimates[k].mean << " +- "
          << estimates[k].standard_error() << ", exact " << exact[k] / total;
    }
  }
}

TEST(PixelFilter, SignsAreThoseOfTheFilter) {
  for (const Case& c : cases()) {
    bool is_ever_negative = false;
    for (int i = 0; i < 4096; ++i) {
      const float u = (float(i) + 0.5f) / 4096;
      const float x = c.filter.sample_offset_px(u), weight = c.filter.sample_weight(u, 0.5f);
      EXPECT_EQ(weight < 0, c.density(x) < 0) << c.name << " at " << x;
      is_ever_negative |= weight < 0;
    }
    EXPECT_EQ(is_ever_negative, c.filter.is_signed()) << c.name;
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

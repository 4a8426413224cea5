// Fresnel's equations and microfacet distributions against independent formulas in double.
//
// Seen to fail when: PLANTED.
#include "bsdf/fresnel.h"

#include "bsdf/microfacet_distribution.h"

#include <complex>
#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

constexpr double pi_d = std::numbers::pi;

TEST(Fresnel, DielectricsFollowTheLawsOfSinesAndTangents) {
  for (const double eta : {1.5, 1.0003, 1 / 1.5, 2.4, 0.3})
    for (double degrees = 0.5; degrees < 90; degrees += 0.5) {
      const double i = degrees * pi_d / 180, sine = std::sin(i) / eta;
      const Refraction<float> found = refract(float(std::cos(i)), float(eta));
      if (sine > 1 + 1e-6) {
        EXPECT_EQ(found.reflectance, 1);
        EXPECT_EQ(found.cos_theta_t, 0);
      } else if (sine < 1 - 1e-6) {
        const double t = std::asin(sine);
        const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
        // Near the critical angle the cosine is a square root of a small difference.
        EXPECT_NEAR(found.reflectance, 0.5 * (s * s + p * p), 1e-6 + 1e-6 / std::cos(t))
            << eta << " " << degrees;
        EXPECT_NEAR(found.cos_theta_t, std::cos(t), 1e-6 + 1e-6 / std::cos(t));
      }
    }
  EXPECT_NEAR(refract(1.0f, 1.5f).reflectance, 0.04, 1e-7);
  EXPECT_EQ(refract(0.0f, 1.5f).reflectance, 1);
  for (const float cosine : {1.0f, 0.5f, 1e-3f, 1e-6f}) {  // Equal indices: nothing happens.
    EXPECT_EQ(refract(cosine, 1.0f).reflectance, 0);
    EXPECT_FLOAT_EQ(refract(cosine, 1.0f).cos_theta_t, cosine);
  }
}

TEST(Fresnel, DiffuseLightIsReflectedAsTabulated) {
  // The mean over cosine-distributed directions, for index 1.5: 0.0918 from outside; from inside
  // 1 - (1 - 0.0918) / 1.5^2 by reciprocity.
  const auto mean = [](float eta) {
    constexpr int n = 200000;
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += refract(float(std::sqrt((i + 0.5) / n)), eta).reflectance;
    return sum / n;
  };
  EXPECT_NEAR(mean(1.5f), 0.0918, 1e-4);
  EXPECT_NEAR(mean(1 / 1.5f), 1 - (1 - mean(1.5f)) / 2.25, 1e-4);
}

TEST(Fresnel, ConductorsFollowTheComplexFormula) {
  using Complex = std::complex<double>;
  for (const auto& [eta, k] :
       {std::pair{0.2, 3.9}, {1.1, 2.1}, {2.9, 3.0}, {0.0, 1.0}, {1.5, 0.0}, {1.0, 0.0}, {0.05, 0.01}})
    for (double cosine = 0; cosine <= 1; cosine += 0.01) {
      const Complex index{eta, k}, cos_t = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
      const Complex s = (cosine - index * cos_t) / (cosine + index * cos_t),
                    p = (index * cosine - cos_t) / (index * cosine + cos_t);
      const double expected = cosine == 0 ? 1 : 0.5 * (std::norm(s) + std::norm(p));
      if (cosine == 0 && eta == 1 && k == 0) continue;  // No surface: any value will do.
      EXPECT_NEAR(conductor_reflectance(float(cosine), float(eta), float(k)), expected, 1e-4)
          << eta << " " << k << " " << cosine;
    }
}

using Kind = MicrofacetDistribution::Kind;

/// The integral of f over the hemisphere of h, even in the angle from the pole stretched by alpha.
template <class Function>
double integral_over_normals(double alpha, const Function& f) {
  constexpr int rows = 2000, columns = 180;
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    // tan(theta) = alpha x / (1 - x)
    const double x = (i + 0.5) / rows, tangent = alpha * x / (1 - x),
                 slope = alpha / ((1 - x) * (1 - x)) / rows;
    const double cosine = 1 / std::sqrt(1 + tangent * tangent);
    for (int k = 0; k < columns; ++k) {
      const double phi = 2 * pi_d * (k + 0.5) / columns, radius = tangent * cosine;
      // sin dtheta = sin cos^2 dtan
      sum += f(Vec3f{float(radius * std::cos(phi)), float(radius * std::sin(phi)), float(cosine)}) * radius *
             cosine * cosine * slope * 2 * pi_d / columns;
    }
  }
  return sum;
}

TEST(MicrofacetDistribution, NormalsCoverTheSurfaceAndVisibleOnesItsProjection) {
  for (const Kind kind : {Kind::beckmann, Kind::ggx})
    for (const float alpha : {0.001f, 0.1f, 0.5f, 1.0f, 5.0f}) {
      const MicrofacetDistribution distribution{kind, alpha};
      EXPECT_NEAR(integral_over_normals(alpha, [&](const Vec3f& h) { return distribution.density(h) * h.z; }),
                  1, 1e-3)
          << int(kind) << " " << alpha;
      for (const float z : {1.0f, 0.9f, 0.4f, 0.05f, 0.001f, 0.0f}) {
        const Vec3f wo{std::sqrt(1 - z * z), 0, z};
        const double visible = integral_over_normals(
            alpha, [&](const Vec3f& h) { return distribution.density(h) * std::max(dot(wo, h), 0.0f); });
        EXPECT_NEAR(visible * distribution.shadowing_over_cos(z), 1, 3e-3)
            << int(kind) << " " << alpha << " " << z;
      }
    }
}

}  // namespace
}  // namespace etendue

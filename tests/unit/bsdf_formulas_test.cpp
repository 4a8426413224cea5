// Fresnel's equations, microfacet distributions and Nori's blend against independent formulas in double.
//
// Seen to fail when: Newton's iteration for Beckmann's visible normals takes one step; the lobe of the blend
// has twice ks; its shadowing is exact; r_p has the cosines swapped; the refracted cosine is that of 1 / eta.
#include "bsdf/fresnel.h"
#include "bsdf/microfacet.h"
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

using DistributionKind = MicrofacetDistribution::Kind;

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
  for (const DistributionKind kind : {DistributionKind::beckmann, DistributionKind::ggx})
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

TEST(MicrofacetDistribution, VisibleSlopesOfBeckmannInvertTheirDistribution) {
  const MicrofacetDistribution distribution{DistributionKind::beckmann, 1};
  for (const float z : {1.0f, 0.9999f, 0.99f, 0.95f, 0.9f, 0.7f, 0.4f, 0.1f, 0.01f, 0.0f}) {
    const double sine = std::sqrt((1 - double(z)) * (1 + double(z)));
    // How many normals with a slope below x wo sees: Heitz and d'Eon 2014, supplement.
    const auto share = [&](double x) {
      return z * (1 + std::erf(x)) + sine * std::exp(-x * x) / std::sqrt(pi_d);
    };
    const double all = z == 1 ? 2 : share(z / sine);
    for (double u = 0.0005; u < 1; u += 0.001) {
      const Vec3f h = distribution.sample_visible(Vec3f{float(sine), 0, z}, Vec2f{0.5f, float(u)});
      EXPECT_NEAR(share(-h.x / double(h.z)) / all, u, 1e-5) << z << " " << u;
    }
  }
}

TEST(Microfacet, IsTheFormulaOfNori) {
  Microfacet model;
  model.kd = {0.2f, 0.1f, 0.4f};
  model.ks = model.coat_probability = 0.6f;
  model.distribution = {DistributionKind::beckmann, 0.3f};
  model.indices = {1.5f, 1 / 1.5f};
  const auto shadowing = [](double cosine) {
    const double b = cosine / (0.3 * std::sqrt(1 - cosine * cosine));
    return b < 1.6 ? (3.535 * b + 2.181 * b * b) / (1 + 2.276 * b + 2.577 * b * b) : 1;
  };
  for (const double o : {0.2, 0.7, 1.3, 1.5})
    for (const double i : {0.1, 0.8, 1.4})
      for (const double phi : {0.0, 2.5, 3.1}) {
        const Vec3<double> wo{std::sin(o), 0, std::cos(o)},
            wi{std::sin(i) * std::cos(phi), std::sin(i) * std::sin(phi), std::cos(i)}, h = normalize(wo + wi);
        const double tan_sq = (1 - h.z * h.z) / (h.z * h.z);
        const double density = std::exp(-tan_sq / 0.09) / (pi_d * 0.09 * std::pow(h.z, 3));  // Times cos_h.
        const double incidence = std::acos(dot(wo, h)), refracted = std::asin(std::sin(incidence) / 1.5);
        const double s = std::sin(incidence - refracted) / std::sin(incidence + refracted),
                     p = std::tan(incidence - refracted) / std::tan(incidence + refracted);
        const double lobe = 0.6 * density * 0.5 * (s * s + p * p) * shadowing(wo.z) * shadowing(wi.z) /
                            (4 * wo.z * wi.z * h.z);
        const auto single = [](const Vec3<double>& v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
        const Colorf f = model.eval(single(wo), single(wi));
        EXPECT_NEAR(f.r, 0.2 / pi_d + lobe, 1e-4 * (1 + lobe));
        EXPECT_NEAR(f.b, 0.4 / pi_d + lobe, 1e-4 * (1 + lobe));
        EXPECT_NEAR(model.pdf_solid_angle(single(wo), single(wi)),
                    0.6 * density / (4 * dot(wo, h)) + 0.4 * wi.z / pi_d, 1e-4 * (1 + density));
      }
}

}  // namespace
}  // namespace etendue

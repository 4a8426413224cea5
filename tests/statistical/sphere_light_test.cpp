// Spheres by the cosine at the receiver: where samples fall, what they add up to, and that hits have the
// density of the samples that find them.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: nothing is cut off at the horizon, or too little; the ellipse is a circle, or squeezed
// the other way; a direction is not lifted to the sphere; a cap with its axis below the horizon is as wide as
// others; the measure is half; a slice is not filled evenly, or only on one side; the straight lines have one
// height to start from; the normal is not turned to the lit side; hits have the density of the cone; the
// angle at the centre is 0.
#include "light/light.h"
#include "sphere_cells.h"
#include "stats/chi_squared.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <gtest/gtest.h>
#include <random>
#include <string>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 500;  // At least as many tests as are made below.
constexpr int samples = 40000;
constexpr double pi_d = std::numbers::pi;

constexpr std::int32_t front = lit_side::front, back = lit_side::back;

/// A sphere of radius 1 whose centre is `distance` away, `angle_deg` from the normal; the whole is turned.
struct SphereCase {
  double distance, angle_deg;
  std::int32_t lit_sides = front;

  double angle() const { return angle_deg / 180 * pi_d; }
  /// Over that of radiance 1 from everywhere, times pi; Howell's catalogue of configuration factors.
  double irradiance() const {
    const double h = distance, b = angle();
    if (b <= pi_d / 2 - std::asin(1 / h)) return pi_d * std::cos(b) / (h * h);
    if (b >= pi_d / 2 + std::asin(1 / h)) return 0;
    const double x = std::sqrt(h * h - 1), y = -x / std::tan(b), root = std::sqrt(1 - y * y);
    return (std::cos(b) * std::acos(y) - x * std::sin(b) * root) / (h * h) +
           std::atan(std::sin(b) * root / x);
  }
};

struct Scene {
  Lights lights;
  Receiver<float> receiver;
  Sphere sphere;

  explicit Scene(const SphereCase& c) {
    const WideFrame frame(normalize(Vec3<double>{0.3, -0.5, 0.7}));
    const Vec3<double> to_center =
        frame.world_from_local({std::sin(c.angle()) * 0.6, std::sin(c.angle()) * 0.8, std::cos(c.angle())});
    sphere = {narrow(to_center * c.distance), 1};
    lights.add<SphereLights>({1, 1, 1}, "sphere", sphere);
    const Vec3f ns = narrow(frame.n) * (c.lit_sides == back ? -1.0f : 1.0f);
    receiver = {{0, 0, 0}, ns, ns, c.lit_sides};
  }
  LightSample<float> sample(std::mt19937& random, LightTechnique technique) const {
    const std::uint32_t u_x = random();
    return lights.sample<float>(0, 1, receiver, {u_x, std::uint32_t(random())}, true, whole_light, technique);
  }
  /// Of a direction to the sphere.
  float pdf(const Vec3f& wi, LightTechnique technique) const {
    const Vec3<double> w = widen(wi), center = widen(sphere.center);
    const double along = dot(w, center), inside = along * along - length_sq(center) + 1;
    const Vec3<double> at = w * (along - std::sqrt(std::max(inside, 0.0)));
    return lights.pdf_solid_angle<float>(
        0, 1, receiver, {narrow(at), normalize(narrow(at - center)), wi, 0, false, technique}, true);
  }
  double cosine(const Vec3f& wi) const {
    return dot(wi, receiver.ns) * (receiver.lit_sides == back ? -1.0 : 1.0);
  }
};

const std::vector<SphereCase> cases{{2, 0},
                                    {2, 45},
                                    {2, 45, back},
                                    {2, 60},
                                    {2, 70},
                                    {2, 70, back},
                                    {2, 90},
                                    {2, 119},
                                    {1.2, 20},
                                    {1.2, 80},
                                    {1.05, 100},
                                    {1.05, 160},
                                    {1.001, 5},
                                    {1.001, 95},
                                    {30, 10},
                                    {30, 88.5},
                                    {30, 90},
                                    {30, 91.5},
                                    {300, 89.9},
                                    {300, 90.05},
                                    {1e4, 60},
                                    {1e6, 80},
                                    {2, 0, front | back}};

std::string name_of(const SphereCase& c) {
  return "distance " + std::to_string(c.distance) + ", " + std::to_string(c.angle_deg) + " degrees, sides " +
         std::to_string(c.lit_sides);
}

TEST(SphereLights, SendWhatTheCatalogueSaysByEveryTechnique) {
  for (const SphereCase& c : cases)
    for (const LightTechnique technique :
         {LightTechnique::solid_angle, LightTechnique::projected_solid_angle}) {
      const Scene scene(c);
      std::mt19937 random(3);
      RunningStatistics irradiance;
      int odd_densities = 0;
      for (int i = 0; i < samples; ++i) {
        const LightSample<float> sample = scene.sample(random, technique);
        if (sample.is_there) {
          EXPECT_NEAR(length(sample.wi), 1, 1e-6);
          EXPECT_NEAR(sample.radiance_over_pdf.r * sample.pdf_solid_angle, 1, 1e-5);
          const float found = scene.pdf(sample.wi, technique);
          // By the cone a point at the rim has the density of an area that is seen edge on.
          odd_densities += !(std::abs(found - sample.pdf_solid_angle) < 1e-2f * sample.pdf_solid_angle);
        }
        irradiance.add(sample.is_there ? std::max(scene.cosine(sample.wi), 0.0) * sample.radiance_over_pdf.r
                                       : 0);
      }
      EXPECT_LT(odd_densities, 2e-3 * samples) << name_of(c);
      const double exact = c.irradiance();
      const MeanTest test = t_test(irradiance, exact, exact * exact * 1e-7);
      EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
          << name_of(c) << ", technique " << light_technique_name(technique) << ": " << irradiance.mean
          << " +- " << irradiance.standard_error() << ", exact " << exact;
    }
}

TEST(SphereLights, LeaveADiffuseReceiverLittleOrNoVariance) {
  for (const SphereCase& c : cases) {
    const bool is_whole = c.angle() <= pi_d / 2 - std::asin(1 / c.distance);
    const bool is_low = std::cos(c.angle()) + 1 / c.distance < 1e-3;
    if (is_low || c.lit_sides == (front | back)) continue;
    const Scene scene(c);
    std::mt19937 random(4);
    RunningStatistics irradiance;
    for (int i = 0; i < 4000; ++i) {
      const LightSample<float> sample = scene.sample(random, LightTechnique::projected_solid_angle);
      ASSERT_TRUE(sample.is_there) << name_of(c);
      irradiance.add(scene.cosine(sample.wi) * sample.radiance_over_pdf.r);
    }
    EXPECT_LT(std::sqrt(irradiance.variance()), (is_whole ? 1e-3 : 0.037) * c.irradiance()) << name_of(c);
  }
}

/// Cells of the cap around the axis; what is below the horizon stays empty.
TEST(SphereLights, PutSamplesWhereTheirDensitySays) {
  for (const SphereCase& c : cases) {
    if (c.distance > 500 || c.lit_sides == (front | back)) continue;
    const Scene scene(c);
    const WideFrame frame(normalize(widen(scene.sphere.center)));
    const double depth = 1 - std::sqrt(1 - 1 / (c.distance * c.distance));  // 1 - cos of the cap's radius
    const auto cells = even_cells(8, 16);
    const auto direction = [&](const Vec3<double>& stretched) {
      const double one_minus_cos = 0.5 * (1 - stretched.z) * depth,
                   sine = std::sqrt(one_minus_cos * (2 - one_minus_cos)),
                   flat = std::hypot(stretched.x, stretched.y);
      return narrow(
          frame.world_from_local({sine * stretched.x / flat, sine * stretched.y / flat, 1 - one_minus_cos}));
    };
    std::vector<double> expected = cells.integrals(
                            [&](const Vec3<double>& stretched) {
                              const Vec3f wi = direction(stretched);
                              if (scene.cosine(wi) <= 0) return 0.0;
                              return 0.5 * depth * scene.pdf(wi, LightTechnique::projected_solid_angle);
                            },
                            12),
                        observed(cells.size());
    double total = 0;
    for (double& e : expected) total += e;
    EXPECT_NEAR(total, 1, 5e-3) << name_of(c);
    for (double& e : expected) e *= samples / total;
    std::mt19937 random(5);
    for (int i = 0; i < samples; ++i) {
      const LightSample<float> sample = scene.sample(random, LightTechnique::projected_solid_angle);
      EXPECT_GT(scene.cosine(sample.wi), -1e-6) << name_of(c);
      const Vec3<double> w = frame.local_from_world(widen(sample.wi));
      const double sin_sq = w.x * w.x + w.y * w.y, one_minus_cos = sin_sq / (1 + std::sqrt(1 - sin_sq));
      const double z = 1 - 2 * std::min(one_minus_cos / depth, 1.0),
                   scale = std::sqrt(std::max(0.0, 1 - z * z) / std::max(sin_sq, 1e-30));
      ++observed[cells.cell_of({w.x * scale, w.y * scale, z})];
    }
    const ChiSquaredTest test = chi_squared_test(observed, expected, {.most_in_empty_cell = 5});
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << name_of(c) << ": chi-squared " << test.statistic << ", " << test.degrees_of_freedom
        << " degrees of freedom";
  }
}

TEST(SphereLights, EndShadowSegmentsJustOffTheSphere) {
  for (const SphereCase& c : cases) {
    const Scene scene(c);
    std::mt19937 random(6);
    for (int i = 0; i < 1000; ++i) {
      const LightSample<float> sample = scene.sample(random, LightTechnique::projected_solid_angle);
      if (!sample.is_there) continue;
      const Vec3<double> end = widen(sample.end);
      const double off = length(end - widen(scene.sphere.center)) - 1, size = c.distance + 3;
      EXPECT_GE(off, -1e-7 * size) << name_of(c);
      EXPECT_LE(off, 3e-6 * size) << name_of(c);
      EXPECT_LT(length(end - widen(sample.wi) * length(end)), 4e-6 * size) << name_of(c);
    }
  }
}

}  // namespace
}  // namespace etendue

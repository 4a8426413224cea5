// Samples of convex polygons by solid angle, by projected solid angle and by glossy lobes fall where they
// should.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: a triangle is chosen by half of the solid angle; what is left of u is not stretched
// back; the point on the far side is uniform along it, or the point towards it; two of Lexell's cosines are
// swapped; a sector's azimuth is uniform, or has no Newton step, or one; a height has u squared; the long
// side is taken for the short ones; what is below the horizon is not cut off; a radius has no root; no
// polygon is around the zenith; a lobe's polygon keeps its height, or is not turned for receivers behind it;
// the axes of a lobe are mirrored; its density has the third power of the length.
#include "bsdf/bsdf.h"
#include "light/lobe_polygon.h"
#include "light/polygon_table.h"
#include "light/projected_polygon.h"
#include "light/spherical_polygon.h"
#include "plane_cells.h"
#include "polygon_cases.h"
#include "stats/chi_squared.h"
#include "stats/significance.h"

#include <functional>
#include <gtest/gtest.h>
#include <string>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 400;  // At least as many tests as are made below.
constexpr int samples = 20000;

/// \param sample gives a direction
void expect_shares(const PolygonCase& c, const std::function<long double(const Outline&)>& measure,
                   const std::function<Vec3f(const Vec2f&)>& sample, const std::string& what) {
  const PlaneCells cells(c.outline());
  std::vector<double> expected = cells.shares(measure), observed(expected.size(), 0.0);
  for (double& share : expected) share = std::max(share, 0.0) * samples;
  std::mt19937 random(5);
  for (int i = 0; i < samples; ++i) {
    const auto unit = [&] { return float(random() >> 8) * 0x1p-24f; };
    const float u_x = unit();
    ++observed[cells.cell_of(extended(sample({u_x, unit()})))];
  }
  const ChiSquaredTest test = chi_squared_test(observed, expected, {.most_in_empty_cell = 1e-3 * samples});
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << what << ": chi-squared " << test.statistic << ", " << test.degrees_of_freedom
      << " degrees of freedom";
}

TEST(LightTechniques, PutSamplesWhereTheirDensitySays) {
  constexpr int polygons = 10;
  for (std::size_t kind = 0; kind < polygon_case_kinds.size(); ++kind) {
    PolygonCases cases(21);
    for (int found = 0; found < polygons;) {
      const PolygonCase c = cases.next(kind);
      PolygonTable table;
      const PolygonFan<float> fan = table.seen_from<float>(c.position, table.add(c.corners), true);
      const Frame<float> frame(c.ns);
      const ProjectedPolygon<float> projected(fan, frame);
      // Where rounding moves samples by less than the test would find.
      if (!(fan.height > 0) || !projected.is_accurate() || !(c.condition() < 3000)) continue;
      ++found;
      const std::string what = std::string(polygon_case_kinds[kind]) + " " + std::to_string(found);
      const SphericalPolygon<float> spherical(fan);
      expect_shares(
          c, [](const Outline& part) { return solid_angle(part); },
          [&](const Vec2f& u) { return spherical.sample(u); }, what + ", solid angle");
      expect_shares(
          c, [&](const Outline& part) { return projected_solid_angle(part, extended(c.ns)); },
          [&](const Vec2f& u) { return frame.world_from_local(projected.sample(u)); }, what + ", projected");
    }
  }
}

/// Of each kind, smooth to rough.
GlossyLobes fitted_lobes() {
  GlossyLobes lobes;
  for (const ltc::Table* table : {&ltc::ggx, &ltc::beckmann, &ltc::phong})
    for (const float roughness : {0.01f, 0.1f, 0.3f, 1.0f}) {
      const GlossyLobe lobe{*table, roughness, [](float) { return 1.0f; }, 0};
      lobes.add(&lobe);
    }
  return lobes;
}

Vec3l seen_through(const LinearlyTransformedCosine<float>& lobe, const Vec3l& v) {
  return {dot(extended(lobe.row_x), v), dot(extended(lobe.row_y), v), dot(extended(lobe.row_z), v)};
}

TEST(LightTechniques, PutSamplesWhereALobeIs) {
  constexpr int polygons = 10;
  const GlossyLobes lobes = fitted_lobes();
  std::mt19937 random(31);
  for (std::size_t kind = 0; kind < polygon_case_kinds.size(); ++kind) {
    PolygonCases cases(22);
    for (int found = 0, tried = 0; found < polygons && tried < 3000; ++tried) {
      const PolygonCase c = cases.next(kind);
      PolygonTable table;
      const PolygonFan<float> fan = table.seen_from<float>(c.position, table.add(c.corners), true);
      // Every other lobe is aimed at a corner.
      const auto unit = [&] { return 2 * float(random() >> 8) * 0x1p-24f - 1; };
      const Vec3f aside{unit(), unit(), unit()};
      const Vec3f aim = tried % 2 == 0 ? normalize(fan.apex) : normalize(aside);
      if (!(dot(aim, c.ns) > 0.02f)) continue;
      const Vec3f wo = normalize(c.ns * (2 * dot(aim, c.ns)) - aim);
      const LinearlyTransformedCosine<float> lobe =
          lobes.at<float>(std::int32_t(random() % 12), c.ns, wo).shape;
      const LobePolygon<float> polygon(fan, lobe);
      if (!(fan.height > 0) || !polygon.is_accurate() || !(c.condition() < 300)) continue;
      const auto measure = [&](const Outline& part) {
        Outline through;
        for (const Vec3l& corner : part) through.push_back(seen_through(lobe, corner));
        return projected_solid_angle(through, {0, 0, 1});
      };
      const double share = double(measure(c.outline())) / std::numbers::pi;
      EXPECT_NEAR(polygon.share(), share, 5e-3 * share) << polygon_case_kinds[kind] << " " << tried;
      const std::vector<Vec3f> turned(c.corners.rbegin(), c.corners.rend());
      const PolygonFan<float> back = table.seen_from<float>(c.position, table.add(turned), true, true);
      EXPECT_NEAR(LobePolygon<float>(back, lobe).share(), share, 5e-3 * share) << "from behind, " << tried;
      ++found;
      expect_shares(
          c, measure, [&](const Vec2f& u) { return polygon.sample(u); },
          std::string(polygon_case_kinds[kind]) + " " + std::to_string(tried) + ", lobe");
    }
  }
}

Material phong_lobe(float exponent) {
  Phong phong;
  phong.exponent = exponent;
  phong.specular_probability = 1;
  return phong;
}
Material metal(MicrofacetDistribution::Kind kind, float alpha) {
  RoughConductor metal;
  metal.distribution = {kind, alpha};
  return metal;
}
Material coat(float alpha) {
  Microfacet coat;
  coat.distribution.alpha = alpha;
  coat.coat_probability = 1;
  return coat;
}

TEST(GlossyLobes, HaveTheShapeOfTheirMaterials) {
  // The second moment of samples of the mixture, as estimates of the material's density: 1.05 for the
  // best, less where it loses samples below the horizon.
  using enum MicrofacetDistribution::Kind;
  const Materials materials({phong_lobe(5), phong_lobe(50), phong_lobe(5000), metal(ggx, 0.005f),
                             metal(ggx, 0.05f), metal(ggx, 0.3f), metal(beckmann, 0.07f), coat(0.2f)});
  std::mt19937 random(8);
  const auto unit = [&] { return float(random() >> 8) * 0x1p-24f; };
  for (std::int32_t id = 0; id < materials.count(); ++id)
    for (const float angle : {0.0f, 0.3f, 0.8f, 1.2f}) {
      ASSERT_TRUE(materials.lobes().has<float>(id));
      const Vec3f wo{0.8f * std::sin(angle), -0.6f * std::sin(angle), std::cos(angle)};
      const LinearlyTransformedCosine<float> lobe = materials.lobes().at<float>(id, {0, 0, 1}, wo).shape;
      double sum = 0;
      for (int i = 0; i < samples; ++i) {
        const Vec2f u{unit(), unit()};
        const BsdfSample<float> sample = std::visit(
            [&](const auto& model) {
              return model.at(Vec2f{0, 0}, true).sample(wo, u);
            },
            materials[id]);
        const double by_lobe = lobe.density_times_pi(sample.wi_local) / std::numbers::pi;
        sum += sample.pdf_solid_angle / (0.95 * by_lobe + 0.05 / (2 * std::numbers::pi));
      }
      EXPECT_LT(sum / samples, 1.6) << "material " << id << ", angle " << angle;
      EXPECT_GT(sum / samples, 0.8) << "material " << id << ", angle " << angle;
    }
}

}  // namespace
}  // namespace etendue

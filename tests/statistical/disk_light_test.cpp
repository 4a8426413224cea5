// Disks and ellipses by every technique: where samples fall, what they add up to, and that hits have the
// density of the samples that find them.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the density leaves out the slope of a part; the cone's axis is on the wrong side; the
// cross term of its section lacks the distance, or its sign; a ring is chosen by its radius; hits have the
// angle of a circular cone; ellipses get no step of Newton's method; all disks are by area, or hits alone; a
// sheared disk has wrong half axes; quadrants are not mirrored; the back of a disk is seen as its front.
#include "disk_cases.h"
#include "light/light.h"
#include "plane_cells.h"
#include "stats/chi_squared.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <gtest/gtest.h>
#include <string>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 500;  // At least as many tests as are made below.
constexpr int samples = 20000;

constexpr std::array techniques{LightTechnique::area, LightTechnique::solid_angle,
                                LightTechnique::projected_solid_angle, LightTechnique::automatic};

Lights lights_of(const Disk& disk, bool is_twosided = false) {
  Lights lights;
  lights.add<DiskLights>({1, 1, 1}, "disk", disk);
  if (is_twosided) lights.set_twosided(0);
  return lights;
}

Receiver<float> receiver_of(const DiskCase& c) { return {c.position, c.ns, c.ns, lit_side::front}; }

class Samples {
 public:
  Samples(const Lights& lights, const Receiver<float>& receiver, LightTechnique technique, unsigned seed)
      : lights_(lights), receiver_(receiver), technique_(technique), random_(seed) {}
  LightSample<float> next() {
    const std::uint32_t u_x = random_();
    return lights_.sample<float>(0, 1, receiver_, {u_x, std::uint32_t(random_())}, true, whole_light,
                                 technique_);
  }

 private:
  const Lights& lights_;
  const Receiver<float>& receiver_;
  LightTechnique technique_;
  std::mt19937 random_;
};

/// On the disk's plane, where the direction meets it, from the receiver.
Vec3l place_of(const DiskCase& c, const Vec3f& wi) {
  const Vec3l ng = extended(c.disk.ng), direction = extended(wi);
  return direction * (dot(extended(c.disk.center) - extended(c.position), ng) / dot(direction, ng));
}

void expect_hit_density(const DiskCase& c, const Lights& lights, const LightSample<float>& sample,
                        LightTechnique technique, const std::string& what) {
  const Vec3l place = place_of(c, sample.wi) + extended(c.position);
  const Vec3f ng = dot(c.disk.ng, sample.wi) > 0 ? -c.disk.ng : c.disk.ng;
  const LightHit<float> hit{
      {float(place.x), float(place.y), float(place.z)}, ng, sample.wi, 0, false, technique};
  const float found = lights.pdf_solid_angle<float>(0, 1, receiver_of(c), hit, true);
  EXPECT_NEAR(found, sample.pdf_solid_angle, (2e-5 + 1e-6 * c.condition()) * sample.pdf_solid_angle) << what;
}

TEST(DiskLights, AreSampledAllButUniformlyInTheirSolidAngle) {
  for (std::size_t kind = 0; kind < disk_case_kinds.size(); ++kind) {
    DiskCases cases(31);
    for (int trial = 0; trial < 20; ++trial) {
      const DiskCase c = cases.next(kind);
      const std::string what = std::string(disk_case_kinds[kind]) + " " + std::to_string(trial);
      // Where rounding moves samples by less than the test would find.
      if (c.condition() > 1e5) continue;
      const Lights lights = lights_of(c.disk);
      const Receiver<float> receiver = receiver_of(c);
      const Outline outline = c.outline();
      const auto exact = double(solid_angle(outline));
      Samples pilot(lights, receiver, LightTechnique::solid_angle, 1),
          drawn(lights, receiver, LightTechnique::solid_angle, 2);
      Outline pilot_places;
      for (int i = 0; i < 2000; ++i) pilot_places.push_back(place_of(c, pilot.next().wi));
      const PlaneCells cells(outline, pilot_places);
      std::vector<double> expected = cells.shares([](const Outline& part) { return solid_angle(part); });
      std::vector<double> observed(expected.size());
      for (double& share : expected) share = std::max(share, 0.0) * samples;
      // The density differs from a uniform one by so little that counts by its inverse spread as counts do.
      RunningStatistics measure;
      for (int i = 0; i < samples; ++i) {
        const LightSample<float> sample = drawn.next();
        ASSERT_TRUE(sample.is_there) << what;
        const double over_uniform = 1 / (sample.pdf_solid_angle * exact);
        EXPECT_NEAR(over_uniform, 1, 0.026 + 3e-8 * c.condition()) << what;
        EXPECT_NEAR(sample.radiance_over_pdf.r * sample.pdf_solid_angle, 1, 1e-5);
        measure.add(over_uniform);
        observed[cells.cell_of(extended(sample.wi))] += over_uniform;
        if (i % 16 == 0) expect_hit_density(c, lights, sample, LightTechnique::solid_angle, what);
      }
      const double rounding = 5e-6 + 1e-9 * c.condition();
      const MeanTest test = t_test(measure, 1, samples * rounding * rounding);
      EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
          << what << ": " << measure.mean << " +- " << measure.standard_error() << " of the solid angle";
      EXPECT_LT(std::sqrt(measure.variance()), 0.0115 + rounding) << what;
      const ChiSquaredTest places =
          chi_squared_test(observed, expected, {.most_in_empty_cell = 1e-3 * samples});
      EXPECT_FALSE(is_rejected(places.p_value, family_level, family_size))
          << what << ": chi-squared " << places.statistic << ", " << places.degrees_of_freedom
          << " degrees of freedom";
    }
  }
}

/// \param is_area_bounded whether samples by area have a variance that can be measured
void expect_irradiance(const DiskCase& c, bool is_twosided, double exact, const std::string& what,
                       bool is_area_bounded = true) {
  const Lights lights = lights_of(c.disk, is_twosided);
  const Receiver<float> receiver = receiver_of(c);
  for (const LightTechnique technique : techniques) {
    if (technique == LightTechnique::area && !is_area_bounded) continue;
    Samples drawn(lights, receiver, technique, 3);
    const std::string which = what + ", technique " + std::string(light_technique_name(technique));
    RunningStatistics statistics;
    for (int i = 0; i < samples; ++i) {
      const LightSample<float> sample = drawn.next();
      statistics.add(
          sample.is_there ? double(std::max(dot(sample.wi, c.ns), 0.0f)) * sample.radiance_over_pdf.r : 0);
      if (sample.is_there && i % 64 == 0) expect_hit_density(c, lights, sample, technique, which);
    }
    const MeanTest test = t_test(statistics, exact, exact * exact * 1e-9);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << which << ": " << statistics.mean << " +- " << statistics.standard_error() << ", exact " << exact;
  }
}

TEST(DiskLights, SendWhatTheirOutlinesSayByEveryTechnique) {
  for (std::size_t kind = 0; kind < disk_case_kinds.size(); ++kind) {
    const std::string_view name = disk_case_kinds[kind];
    const bool is_apart = name != "touching" && name != "at the edge";
    DiskCases cases(33);
    for (int trial = 0; trial < 6; ++trial) {
      const DiskCase c = cases.next(kind);
      if (c.condition() > 1e5) continue;
      const std::string what = std::string(disk_case_kinds[kind]) + " " + std::to_string(trial);
      Outline outline = c.outline();
      expect_irradiance(c, false, double(projected_solid_angle(outline, extended(c.ns))), what, is_apart);
      DiskCase turned = c;
      turned.disk.ng = -c.disk.ng;
      expect_irradiance(turned, true, double(projected_solid_angle(outline, extended(c.ns))),
                        what + ", from behind", is_apart);
    }
  }
}

/// Howell's catalogue, B-12 and B-13: an element below a disk, parallel to it, and perpendicular, facing its
/// axis.
TEST(DiskLights, HaveTheShapeFactorsOfElements) {
  struct Row {
    float radius, height, offset;
    double factor;
  };
  const auto above = [](const Row& row) {
    return Disk{{-row.offset, 0, row.height}, {row.radius, 0, 0}, {0, row.radius, 0}, {0, 0, -1}};
  };
  for (const Row& row : {Row{1, 1, 1, 0.276393202250},
                         {1, 2, 0.5f, 0.184703687453},
                         {0.5f, 0.1f, 1, 0.004272852229},
                         {1, 0.5f, 0, 0.8}})
    expect_irradiance({above(row), {0, 0, 0}, {0, 0, 1}}, false, std::numbers::pi * row.factor, "parallel");
  for (const Row& row :
       {Row{1, 1, 1, 0.170820393250}, {1, 2, 1.5f, 0.065635551776}, {0.5f, 0.1f, 1, 0.032186342920}})
    expect_irradiance({above(row), {0, 0, 0}, {-1, 0, 0}}, false, std::numbers::pi * row.factor,
                      "perpendicular");
}

TEST(DiskLights, SendNothingBackwards) {
  const DiskCase c{{{0, 0, 1}, {1, 0, 0}, {0, 0.5f, 0}, {0, 0, 1}}, {0.2f, 0.1f, 0}, {0, 0, 1}};
  const Lights lights = lights_of(c.disk);
  const Receiver<float> receiver = receiver_of(c);
  for (const LightTechnique technique : techniques) {
    Samples drawn(lights, receiver, technique, 4);
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(drawn.next().is_there);
  }
}

}  // namespace
}  // namespace etendue

// Convex polygons by solid angle and by projected solid angle: measures against extended precision and closed
// forms, samples within the polygon.
//
// Seen to fail when: the triple product comes from the corners; nothing is cut off at the horizon, or at a
// wrong place; the side along the horizon is missing; every polygon is around the zenith; all of Dunavant's
// points have one weight; every measure is called accurate; polygons of half a radian are small; the sine of
// small angles has an absolute error of 1e-7; arcs beyond a right angle are mirrored.
#include "base/angles.h"
#include "light/polygon_table.h"
#include "light/projected_polygon.h"
#include "light/spherical_polygon.h"
#include "polygon_cases.h"

#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace etendue {
namespace {

PolygonFan<float> fan_of(const PolygonCase& c) {
  PolygonTable table;
  return table.seen_from<float>(c.position, table.add(c.corners), true);
}

ProjectedPolygon<float> projected(const PolygonCase& c) {
  return ProjectedPolygon<float>(fan_of(c), Frame<float>(c.ns));
}

/// Those with an area and a receiver in front of it.
bool is_seen(const PolygonCase& c) {
  const Outline seen = c.outline();
  long double area = 0;
  for (std::size_t k = 2; k < seen.size(); ++k)
    area += length(cross(seen[k - 1] - seen[0], seen[k] - seen[0]));
  return area > 1e-10L && fan_of(c).height > 0;
}

class PolygonKind : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Of, PolygonKind, ::testing::Range(std::size_t(0), polygon_case_kinds.size()),
                         [](const auto& info) {
                           std::string name = polygon_case_kinds[info.param];
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST_P(PolygonKind, HasTheSolidAngleOfExtendedPrecision) {
  PolygonCases cases(11);
  for (int trial = 0; trial < 4000; ++trial) {
    const PolygonCase c = cases.next(GetParam());
    if (!is_seen(c)) continue;
    const PolygonFan<float> fan = fan_of(c);
    const auto exact = double(solid_angle(c.outline()));
    if (!(exact > 0)) continue;
    const double error = SphericalPolygon<float>(fan).solid_angle() / exact - 1;
    EXPECT_LT(std::abs(error), 1e-6 * c.condition()) << "trial " << trial << ", exact " << exact;
  }
}

TEST_P(PolygonKind, HasTheProjectedSolidAngleOfExtendedPrecision) {
  PolygonCases cases(12);
  int accurate = 0, seen = 0, well_off = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const PolygonCase c = cases.next(GetParam());
    if (!is_seen(c)) continue;
    const auto exact = double(projected_solid_angle(c.outline(), extended(c.ns)));
    if (!(exact > 1e-14)) continue;
    ++seen;
    const auto polygon = projected(c);
    if (!polygon.is_accurate()) continue;
    ++accurate;
    const double error = std::abs(polygon.projected_solid_angle() / exact - 1);
    well_off += error > 1e-4;
    EXPECT_LT(error, 2e-3 + 1e-5 * c.condition()) << "trial " << trial << ", exact " << exact;
  }
  EXPECT_LT(well_off, 0.02 * accurate);
  EXPECT_GT(accurate, 0.2 * seen);
}

TEST_P(PolygonKind, IsWhereItsSamplesLie) {
  PolygonCases cases(13);
  for (int trial = 0; trial < 2000; ++trial) {
    const PolygonCase c = cases.next(GetParam());
    if (!is_seen(c)) continue;
    const PolygonFan<float> fan = fan_of(c);
    const Frame<float> frame(c.ns);
    const SphericalPolygon<float> spherical(fan);
    const ProjectedPolygon<float> cosine(fan, frame);
    const Outline outline = c.outline();
    // By how much a direction (unit) is outside of the planes through the sides.
    const auto outside = [&](const Vec3f& direction) {
      long double most = 0;
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const Vec3l a = outline[k], b = outline[(k + 1) % outline.size()], across = cross(b - a, a);
        if (length(across) > 0) most = std::max(most, -dot(across, extended(direction)) / length(across));
      }
      return double(most);
    };
    for (const Vec2f& u : {Vec2f{float(cases.unit()), float(cases.unit())},
                           {0, 0},
                           {0, 0x1.fffffep-1f},
                           {0x1.fffffep-1f, 0x1.fffffep-1f}}) {
      const Vec3f point = spherical.sample(u);
      // Within the polygon to the rounding of its own size; the direction to that of the place.
      EXPECT_LT(outside(normalize(point)), 1e-6 * c.condition())
          << "trial " << trial << ", u " << u.x << " " << u.y;
      if (!cosine.is_accurate()) continue;
      const Vec3f local = cosine.sample(u);
      EXPECT_NEAR(length(local), 1, 1e-6);
      EXPECT_GE(local.z, 0);
      EXPECT_LT(outside(frame.world_from_local(local)), 1e-4 + 1e-6 * c.condition())
          << "trial " << trial << ", u " << u.x << " " << u.y;
    }
  }
}

/// F of an element at the origin; shape factors times pi are projected solid angles.
double shape_factor(const std::vector<Vec3f>& corners, const Vec3f& ns) {
  const auto polygon = projected({corners, {0, 0, 0}, ns});
  EXPECT_TRUE(polygon.is_accurate());
  return polygon.projected_solid_angle() * std::numbers::inv_pi;
}

TEST(ProjectedPolygon, HasTheShapeFactorsOfRectangles) {
  const auto above = [](float x0, float x1, float y0, float y1, float z) {
    return std::vector<Vec3f>{{x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}};
  };
  // Parallel, below a corner (Howell's B-3), and below the middle.
  EXPECT_NEAR(shape_factor(above(0, 1, 0, 1, 1), {0, 0, 1}), 0.138531605995, 2e-7);
  EXPECT_NEAR(shape_factor(above(0, 2, 0, 1, 1), {0, 0, 1}), 0.167375009914, 2e-7);
  EXPECT_NEAR(shape_factor(above(0, 0.5f, 0, 0.5f, 2), {0, 0, 1}), 0.018369408703, 1e-7);
  EXPECT_NEAR(shape_factor(above(0, 10, 0, 10, 0.1f), {0, 0, 1}), 0.249979543986, 2e-7);
  EXPECT_NEAR(shape_factor(above(-0.5f, 0.5f, -0.5f, 0.5f, 1), {0, 0, 1}), 0.239456470461, 2e-7);
  // Perpendicular (B-4), of twice the height: the lower half is below the horizon.
  const auto upright = [](float a, float b, float c) {
    return std::vector<Vec3f>{{0, c, -a}, {b, c, -a}, {b, c, a}, {0, c, a}};
  };
  EXPECT_NEAR(shape_factor(upright(1, 1, 1), {0, 0, 1}), 0.055734197003, 1e-7);
  EXPECT_NEAR(shape_factor(upright(2, 1, 0.5f), {0, 0, 1}), 0.158774804514, 2e-7);
  EXPECT_NEAR(shape_factor(upright(1, 4, 0.1f), {0, 0, 1}), 0.225044211409, 2e-7);
}

TEST(SphericalPolygon, HasTheSolidAnglesOfACube) {
  const std::vector<Vec3f> face{{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};
  EXPECT_NEAR(SphericalPolygon<float>(fan_of({face, {0, 0, 0}, {}})).solid_angle(), 4 * std::numbers::pi / 6,
              5e-7);
  EXPECT_EQ(SphericalPolygon<float>(fan_of({face, {0, 0, 2}, {}})).solid_angle(), 0) << "from behind";
  EXPECT_EQ(SphericalPolygon<float>(fan_of({face, {5, 0, 1}, {}})).solid_angle(), 0) << "in its plane";
}

TEST(ProjectedPolygon, IsNothingBelowTheHorizonOrFromBehind) {
  const std::vector<Vec3f> face{{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};
  EXPECT_EQ(projected({face, {0, 0, 0}, {0, 0, -1}}).projected_solid_angle(), 0);
  EXPECT_FALSE(projected({face, {0, 0, 0}, {0, 0, -1}}).is_accurate());
  EXPECT_FALSE(projected({face, {0, 0, 2}, {0, 0, -1}}).is_accurate());
}

TEST(Angles, OfHalfATurnAreThoseOfTheLibrary) {
  for (int k = 0; k <= 100000; ++k) {
    const float angle = std::numbers::pi_v<float> * float(k) / 100000;
    float sine, cosine;
    sincos_half_turn(angle, sine, cosine);
    EXPECT_NEAR(sine, std::sin(double(angle)), 3e-7);
    EXPECT_NEAR(cosine, std::cos(double(angle)), 4e-7);
    if (angle < 1) {
      EXPECT_NEAR(sine, std::sin(double(angle)), 3e-7 * double(angle));
    }
    const float x = std::cos(angle) * 3, y = std::max(std::sin(angle), 0.0f) * 3;
    EXPECT_NEAR(half_turn_angle(y, x), std::atan2(double(y), double(x)),
                4e-7 * std::atan2(double(y), double(x)));
  }
  EXPECT_EQ(half_turn_angle(0.0f, 0.0f), 0);
  EXPECT_EQ(half_turn_angle(1e-30f, 2.0f), 0.5e-30f);
}

}  // namespace
}  // namespace etendue

#include "base/transform.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

using V = Vec3<double>;

void expect_near(const V& a, const V& b, double tolerance = 1e-14) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Transform, TheRightFactorActsFirst) {
  const Transform t = translation({1, 2, 3}) * scaling({10, 20, 30});
  expect_near(transform_point(t, {1, 1, 1}), {11, 22, 33});
  expect_near(transform_vector(t, {1, 1, 1}), {10, 20, 30});
  expect_near(transform_point(scaling({10, 20, 30}) * translation({1, 2, 3}), {0, 0, 0}), {10, 40, 90});
}

TEST(Transform, RotationIsCounterClockwiseAboutAnyLengthOfAxis) {
  expect_near(transform_point(rotation({0, 0, 5}, 90), {1, 0, 0}), {0, 1, 0});
  expect_near(transform_point(rotation({0.1, 0, 0}, 90), {0, 1, 0}), {0, 0, 1});
  expect_near(transform_point(rotation({1, 1, 1}, 120), {1, 0, 0}), {0, 1, 0});
  const Transform t = rotation({1, -2, 0.5}, 33);
  EXPECT_NEAR(determinant(t), 1, 1e-14);
  expect_near(transform_vector(t, {1, -2, 0.5}), {1, -2, 0.5});
}

TEST(Transform, LookAtHasNorisColumns) {
  const Transform t = look_at({1, 2, 3}, {1, 2, 10}, {0, 4, 4});
  expect_near(transform_vector(t, {1, 0, 0}), {1, 0, 0});  // up x direction
  expect_near(transform_vector(t, {0, 1, 0}), {0, 1, 0});
  expect_near(transform_vector(t, {0, 0, 1}), {0, 0, 1});
  expect_near(transform_point(t, {0, 0, 0}), {1, 2, 3});

  const Transform down = look_at({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  expect_near(transform_vector(down, {0, 0, 1}), {0, -1, 0});
  expect_near(transform_vector(down, {0, 1, 0}), {0, 0, 1});
  expect_near(transform_vector(down, {1, 0, 0}), {1, 0, 0});  // (0,0,1) x (0,-1,0)
  EXPECT_NEAR(determinant(look_at({3, -1, 2}, {0.1, 0.2, 0.3}, {0.3, 1, 0})), 1, 1e-14);
}

TEST(Transform, LookAtWithoutADirectionIsSingularNotNan) {
  for (const Transform& t :
       {look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}), look_at({0, 0, 0}, {0, 3, 0}, {0, 1, 0}),
        look_at({0, 0, 0}, {0.1, 0.2, 0.3}, {-0.3, -0.6, -0.9}), look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 0})}) {
    EXPECT_EQ(determinant(t), 0);
    EXPECT_FALSE(is_invertible(t));
  }
}

TEST(Transform, NormalsStayPerpendicularAndOutward) {
  const Transform t = translation({5, 6, 7}) * rotation({1, 2, 3}, 50) * scaling({-1, 4, 0.5});
  const V a{1, 2, -1}, b{0, 1, 3}, outward{0.3, 0.2, 1};
  const V n = cross(a, b), moved = transform_normal(t, n);
  EXPECT_NEAR(dot(moved, transform_vector(t, a)), 0, 1e-13);
  EXPECT_NEAR(dot(moved, transform_vector(t, b)), 0, 1e-13);
  EXPECT_NEAR(dot(moved, transform_vector(t, outward)), dot(n, outward), 1e-13);
}

TEST(Transform, IsInvertibleWhateverTheUnit) {
  EXPECT_TRUE(is_invertible({}));
  for (const double unit : {1e-200, 1e-9, 1e9, 1e200}) {
    EXPECT_TRUE(is_invertible(scaling({unit, unit, unit}))) << unit;
    const V n = transform_normal(scaling({unit, unit, unit}), {0, 1, 0});
    EXPECT_DOUBLE_EQ(n.y * unit, 1) << unit;
  }
  const Transform flat = scaling({1e-17, 1, 1}), turned = rotation({1, 2, 3}, 40);
  EXPECT_TRUE(is_invertible(flat * turned));
  EXPECT_TRUE(is_invertible(turned * flat));
}

TEST(Transform, IsNotInvertibleWhereSingularUpToRoundingOrNotFinite) {
  EXPECT_FALSE(is_invertible(scaling({1, 0, 1})));
  EXPECT_FALSE(is_invertible(scaling({0, 0, 0})));
  EXPECT_FALSE(is_invertible({{{{0.1, 0.2, 0.3, 0}, {0.4, 0.5, 0.6, 0}, {0.7, 0.8, 0.9, 0}, {0, 0, 0, 1}}}}));
  EXPECT_FALSE(is_invertible(translation({0, std::nan(""), 0})));
  EXPECT_FALSE(is_invertible(scaling({1, HUGE_VAL, 1})));
}

}  // namespace
}  // namespace etendue

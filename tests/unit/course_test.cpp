// What a student's code is handed, and what is noted of what it asks.
#include "course/stream_sampler.h"
#include "support/course_module.h"
#include "support/error_of.h"
#include "test_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using ::testing::HasSubstr;

/// A white floor at z = 0 under a square lamp of 2 m x 1 m at z = 2 that shines down with radiance 3.
LoadedScene lamp_over_floor() {
  return load_scene_text(camera_xml({0, -4, 2}, {0, 0, 0}, 40, 8, "sobol") +
                         rectangle_xml({0, 0, 0}, {5, 0, 0}, {0, 5, 0}, diffuse_xml(1)) +
                         rectangle_xml({0, 0, 2}, {0, 0.5, 0}, {1, 0, 0}, light_xml(3) + diffuse_xml(0)));
}

TEST(StudentIntegrator, NotesEachCall) {
  const LoadedScene loaded = lamp_over_floor();
  const auto integrator = test::student_integrator("light_integrator", loaded);
  std::vector<Call> calls;
  Colorf radiance{};
  {
    const CallRecording recording(calls);
    StreamSampler sampler(SamplerKind::sobol, {1, 2, 3});
    radiance = integrator->radiance({{0, -1, 1}, {0, 0, -1}}, 0, 10, sampler);
  }
  StreamSampler unnoted(SamplerKind::sobol, {1, 2, 3});
  unnoted.next1D();

  ASSERT_EQ(calls.size(), 7u);
  const auto& camera_ray = std::get<RayCast>(calls[0]);
  EXPECT_EQ(camera_ray.mesh, 0);
  EXPECT_FLOAT_EQ(camera_ray.t, 1);
  EXPECT_FALSE(camera_ray.is_any_hit);
  const auto& numbers = std::get<NumbersDrawn>(calls[1]);
  EXPECT_EQ(numbers.count, 2);
  const auto& point = std::get<PointSampled>(calls[2]);
  EXPECT_EQ(point.mesh, 1);
  EXPECT_EQ(point.u, numbers.u);  // of a single light all of the number is left
  EXPECT_EQ(point.ng, (Vec3f{0, 0, -1}));
  EXPECT_FLOAT_EQ(point.position.z, 2);
  EXPECT_FLOAT_EQ(std::get<DensityAsked>(calls[3]).pdf_area, 0.5f);
  const auto& shadow_ray = std::get<RayCast>(calls[4]);
  EXPECT_TRUE(shadow_ray.is_any_hit);
  EXPECT_EQ(shadow_ray.mesh, -1);
  const auto& emission = std::get<EmissionAsked>(calls[5]);
  EXPECT_EQ(emission.radiance, (Colorf{3, 3, 3}));
  EXPECT_EQ(emission.position, point.position);
  const auto& bsdf = std::get<BsdfAsked>(calls[6]);
  EXPECT_EQ(bsdf.what, BsdfAsked::What::value);
  EXPECT_NEAR(bsdf.wo_local.z, 1, 1e-6);
  EXPECT_NEAR(bsdf.value.r, inv_pi, 1e-6);

  const Vec3f to_light = point.position - Vec3f{0, -1, 0};
  const float cosine = 2 / length(to_light);
  EXPECT_NEAR(radiance.r, 3 * inv_pi * cosine * cosine / length_sq(to_light) / 0.5f, 1e-5);
}

TEST(StudentIntegrator, EachSpellingMeansTheSame) {
  const LoadedScene loaded = lamp_over_floor();
  const auto radiance_of = [&](const char* module, const char* name) {
    const StudentIntegrator integrator(test::course_module(module), name, loaded.scene, loaded.places, {});
    StreamSampler sampler(SamplerKind::sobol, {1, 2, 3});
    return integrator.radiance({{0, -1, 1}, {0, 0, -1}}, 0, 10, sampler).r;
  };
  const float expected = radiance_of("light_integrator", "light");
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(radiance_of("light_2012", "light"), expected, 1e-5f * expected);
  EXPECT_NEAR(radiance_of("light_2012", "later"), expected, 1e-5f * expected);
}

/// Numbers that end.
class GivenNumbers final : public nori::Sampler {
 public:
  float next1D() override { throw nori::NoriException("no numbers are left"); }
  nori::Point2f next2D() override { return {next1D(), 0}; }
};

TEST(StudentIntegrator, WhatItThrowsIsAnError) {
  const LoadedScene loaded = lamp_over_floor();
  const auto integrator = test::student_integrator("light_integrator", loaded);
  GivenNumbers sampler;
  EXPECT_THAT(test::error_of([&] {
                integrator->radiance({{0, -1, 1}, {0, 0, -1}}, 0, 10, sampler);
              }),
              HasSubstr("libcourse_light_integrator.so: no numbers are left"));
}

TEST(StudentScene, LightsAreDarkBehind) {
  const LoadedScene loaded = lamp_over_floor();
  const StudentScene scene(loaded.scene, loaded.places);
  ASSERT_EQ(scene.getLuminaires().size(), 1u);
  const nori::Luminaire& lamp = *scene.getLuminaires()[0];
  const nori::Point3f on_lamp(0, 0, 2);
  const nori::Normal3f down(0, 0, -1);
  EXPECT_EQ(lamp.eval({&lamp, nori::Point3f(0, 0, 0), on_lamp, down}).r(), 3);
  EXPECT_EQ(lamp.eval({&lamp, nori::Point3f(0, 0, 4), on_lamp, down}).r(), 0);
  EXPECT_EQ(lamp.getMesh(), scene.getMeshes()[1]);
}

TEST(StudentModule, NamesWhatItHas) {
  const StudentModule module = test::course_module("light_integrator");
  ASSERT_EQ(module.classes().size(), 1u);
  EXPECT_STREQ(module.classes()[0].name, "light");
  EXPECT_STREQ(module.classes()[0].group, "7");
  EXPECT_THAT(test::error_of([&] { module.find("lihgt"); }), HasSubstr("did you mean 'light'?"));
  EXPECT_THAT(test::error_of([] { StudentModule("no_such.so"); }), HasSubstr("cannot load the plugin"));
}

TEST(SurfaceSampling, IsUniformOnEachShape) {
  const LoadedScene loaded = load_scene_text(camera_xml({0, -4, 2}, {0, 0, 0}, 40, 8, "sobol") +
                                             sphere_xml({1, 2, 3}, 2, light_xml(1)));
  const StudentScene scene(loaded.scene, loaded.places);
  nori::Point3f p;
  nori::Normal3f n;
  scene.getMeshes()[0]->samplePosition({0.25f, 0.75f}, p, n);
  EXPECT_NEAR((p - nori::Point3f(1, 2, 3)).norm(), 2, 1e-5);
  EXPECT_NEAR(n.norm(), 1, 1e-5);
  EXPECT_NEAR(scene.getMeshes()[0]->pdf(), 1 / (16 * pi), 1e-6);
}

}  // namespace
}  // namespace etendue

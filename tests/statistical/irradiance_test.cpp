// Renders against closed forms: Lambert's polygons, spheres, furnaces.
//
// False-alarm rate of this file: 1e-5 (Sidak over all its t-tests), fixed seeds.
// Seen to fail when: rays start off the surface by a fraction of its coordinates alone, so that a surface at
// the origin shadows itself; a mesh light's pdf_area is 1 % too large; a sphere's cone is 1 % too wide; the
// cosine at the receiver is left out; choice.pmf is left out; the BSDF samples of mis have weight 1; the
// density of mis lacks the probability of the light; Diffuse::eval gives albedo; shadow rays end 5 % early;
// lights shine from behind; shadow rays end inside of a huge sphere.
#include "closed_forms.h"
#include "film_statistics.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 180;  // At least as many tests as are made below.

struct Method {
  const char* name;
  const char* integrator;
  Heuristic heuristic;
};
constexpr Method methods[]{{"light", "light", Heuristic::balance},
                           {"direct", "direct", Heuristic::balance},
                           {"average", "average", Heuristic::balance},
                           {"mis balance", "mis", Heuristic::balance},
                           {"mis power", "mis", Heuristic::power},
                           {"mis maximum", "mis", Heuristic::maximum}};

constexpr int side_px = 32;
const Vec3d eye{1.5, -2.5, 2};

/// A floor point at the origin, seen from `eye`, under `lights`.
LoadedScene floor_scene(const std::string& lights, const std::vector<SceneFile>& files, double albedo,
                        const Vec3d& half_u = {50, 0, 0}, const Vec3d& half_v = {0, 50, 0}) {
  return load_scene_text(camera_xml(eye, {0, 0, 0}, 0.001, side_px, "sobol") +
                             rectangle_xml({0, 0, 0}, half_u, half_v, diffuse_xml(albedo)) + lights,
                         files);
}

void expect_radiance(const Scene& scene, double exact, const std::string& what) {
  for (const Method& method : methods) {
    const RenderResult result =
        render(scene, render_settings(method.integrator, 1024, 4, 7, method.heuristic));
    EXPECT_EQ(result.invalid.count(), 0);
    // All pixels see one point (up to 1e-5 of the distance).
    const RunningStatistics radiance = statistics_of_pixels(result.film, &Color<double>::g);
    const MeanTest test = t_test(radiance, exact, exact * exact * 1e-12);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << what << ", " << method.name << ": " << radiance.mean << " +- " << radiance.standard_error()
        << ", exact " << exact << ", " << test.statistic << " standard errors";
    EXPECT_LT(radiance.standard_error() / exact, 1e-3) << what << ", " << method.name << ": too few samples";
  }
}

constexpr double albedo = 0.6, radiance = 3;
const Vec3d up{0, 0, 1};

TEST(ClosedForm, LambertsFormulaItself) {
  // A square of side 2 at height 1, centred: four times the corner configuration, E = 4 L * 2 * (1 / (2 sqrt
  // 2)) atan(1 / sqrt 2).
  const auto square = rectangle_corners({0, 0, 1}, {1, 0, 0}, {0, -1, 0});
  const double by_parts = 4 * 2 * (1 / (2 * std::sqrt(2.0))) * std::atan(1 / std::sqrt(2.0));
  EXPECT_NEAR(polygon_irradiance(square, 1, {0, 0, 0}, up), by_parts, 1e-12);
  // A huge one fills the hemisphere, a far one is a point.
  EXPECT_NEAR(polygon_irradiance(rectangle_corners({0, 0, 1}, {1e5, 0, 0}, {0, -1e5, 0}), 1, {0, 0, 0}, up),
              std::numbers::pi, 1e-4);
  EXPECT_NEAR(
      polygon_irradiance(rectangle_corners({0, 0, 1000}, {1, 0, 0}, {0, -1, 0}), 1, {0, 0, 0}, up) * 1e6, 4,
      1e-4);
  EXPECT_EQ(polygon_irradiance(rectangle_corners({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), 1, {0, 0, 0}, up), 0);
  // A wall from the floor to infinity gives half of what the hemisphere does, whether or not it goes on
  // below.
  EXPECT_NEAR(polygon_irradiance(rectangle_corners({1, 0, 0}, {0, -1e5, 0}, {0, 0, 1e5}), 1, {0, 0, 0}, up),
              std::numbers::pi / 2, 1e-4);
}

TEST(ClosedForm, MeshLightsOfOneTriangleAndOfAPentagon) {
  const std::vector<Vec3d> triangle{{-0.5, -0.3, 1.2}, {0.1, 1.4, 1.6}, {1.5, 0.2, 1.4}};
  std::vector<Vec3d> pentagon;
  for (int i = 0; i < 5; ++i) {
    const double angle = -0.4 * std::numbers::pi * i;
    pentagon.push_back({0.3 + std::cos(angle), 0.6 + 1.2 * std::sin(angle), 1.1 + 0.2 * std::cos(angle)});
  }
  for (const auto& polygon : {triangle, pentagon}) {
    const LoadedScene loaded = floor_scene(mesh_xml("light.obj", light_xml(radiance)),
                                           {{"light.obj", polygon_obj(polygon)}}, albedo);
    const double irradiance = polygon_irradiance(polygon, radiance, {0, 0, 0}, up);
    ASSERT_GT(irradiance, 0.1);
    expect_radiance(loaded.scene, albedo / std::numbers::pi * irradiance,
                    std::to_string(polygon.size()) + " corners");
  }
}

TEST(ClosedForm, RectangleLightAndAReceiverThatTilts) {
  const Vec3d center{-0.4, 0.5, 1}, half_u{0.8, 0.1, 0.2}, half_v{0.1, -0.7, 0.1};
  const std::string light = rectangle_xml(center, half_u, half_v, light_xml(radiance));
  const auto corners = rectangle_corners(center, half_u, half_v);
  expect_radiance(floor_scene(light, {}, albedo).scene,
                  albedo / std::numbers::pi * polygon_irradiance(corners, radiance, {0, 0, 0}, up),
                  "level floor");
  const Vec3d tilted_u{2, 0, 0.8}, tilted_v{0, 2, -0.5};
  const double irradiance =
      polygon_irradiance(corners, radiance, {0, 0, 0}, normalize(cross(tilted_u, tilted_v)));
  expect_radiance(floor_scene(light, {}, albedo, tilted_u * 0.05, tilted_v * 0.05).scene,
                  albedo / std::numbers::pi * irradiance, "tilted floor");
}

TEST(ClosedForm, ALightPartlyBelowTheHorizon) {
  const Vec3d center{-1, 0.2, 0.3}, half_u{0, 0.8, 0.1}, half_v{0, 0.1, 0.9};
  const double irradiance =
      polygon_irradiance(rectangle_corners(center, half_u, half_v), radiance, {0, 0, 0}, up);
  ASSERT_GT(irradiance, 0.1);
  expect_radiance(floor_scene(rectangle_xml(center, half_u, half_v, light_xml(radiance)), {}, albedo,
                              {0.1, 0, 0}, {0, 0.1, 0})
                      .scene,
                  albedo / std::numbers::pi * irradiance, "partly below");
}

TEST(ClosedForm, SphereLightFarNearAndHuge) {
  for (const auto& [center, radius] :
       {std::pair{Vec3d{-0.8, 1, 2}, 0.9}, std::pair{Vec3d{0.1, 0.05, 0.6}, 0.45},
        std::pair{Vec3d{0, 0, 1e5 + 20}, 1e5}}) {
    const double irradiance = sphere_irradiance(center, radius, radiance, {0, 0, 0}, up);
    expect_radiance(floor_scene(sphere_xml(center, radius, light_xml(radiance)), {}, albedo).scene,
                    albedo / std::numbers::pi * irradiance, "sphere of radius " + std::to_string(radius));
  }
}

TEST(ClosedForm, LightsOfAllKindsTogetherAddUp) {
  const Vec3d center{1, 0.5, 1}, half_u{0.5, 0, 0}, half_v{0, -0.5, 0}, sphere_center{-1, 0.8, 1.2};
  const std::vector<Vec3d> triangle{{-0.5, -1.6, 1.2}, {-0.4, -0.4, 1.6}, {0.6, -1, 1.4}};
  const LoadedScene loaded =
      floor_scene(rectangle_xml(center, half_u, half_v, light_xml(2)) +
                      sphere_xml(sphere_center, 0.4, light_xml(5)) + mesh_xml("light.obj", light_xml(4)),
                  {{"light.obj", polygon_obj(triangle)}}, albedo);
  const double irradiance = polygon_irradiance(rectangle_corners(center, half_u, half_v), 2, {0, 0, 0}, up) +
                            sphere_irradiance(sphere_center, 0.4, 5, {0, 0, 0}, up) +
                            polygon_irradiance(triangle, 4, {0, 0, 0}, up);
  expect_radiance(loaded.scene, albedo / std::numbers::pi * irradiance, "three lights");
}

TEST(ClosedForm, ACoverHidesTheLight) {
  // Half of a large light is covered by a black plate right below it.
  const Vec3d center{0, 0, 2}, half_u{1, 0, 0}, half_v{0, -1, 0};
  const LoadedScene loaded =
      floor_scene(rectangle_xml(center, half_u, half_v, light_xml(radiance)) +
                      rectangle_xml({-2, 0, 1.999}, {2, 0, 0}, {0, -3, 0}, diffuse_xml(0)),
                  {}, albedo);
  // The plate ends at x = 0, as seen from the origin: exactly half of the light is left.
  const double irradiance =
      0.5 * polygon_irradiance(rectangle_corners(center, half_u, half_v), radiance, {0, 0, 0}, up);
  expect_radiance(loaded.scene, albedo / std::numbers::pi * irradiance, "half covered");
}

TEST(Furnace, ASphereAndABoxInsideAConstantLightShowTheirAlbedo) {
  const SceneFile furnace{"furnace.obj", box_obj({0, 0, 0}, 4, true)},
      box{"box.obj", box_obj({0, 0, 0}, 0.5, false)};
  for (const std::string& inside :
       {sphere_xml({0, 0, 0}, 0.5, diffuse_xml(albedo)), mesh_xml("box.obj", diffuse_xml(albedo))}) {
    const LoadedScene loaded = load_scene_text(camera_xml(eye, {0, 0, 0}, 0.001, side_px, "sobol") + inside +
                                                   mesh_xml("furnace.obj", light_xml(radiance)),
                                               {furnace, box});
    expect_radiance(loaded.scene, albedo * radiance, "furnace");
    // BSDF sampling has no variance here: every ray meets the light with weight albedo.
    const RenderResult result = render(loaded.scene, render_settings("direct", 256, 4, 1));
    for (int i = 0; i < side_px; ++i) EXPECT_NEAR(result.film.at(i, i).mean.r / (albedo * radiance), 1, 1e-6);
  }
}

TEST(Furnace, WhatTheCameraSeesOfALightIsItsRadianceAndNothingFromBehind) {
  for (const double side : {1.0, -1.0}) {
    const LoadedScene loaded = load_scene_text(
        camera_xml({0.2, 0.1, 3}, {0, 0, 0}, 0.1, side_px, "independent") +
        rectangle_xml({0, 0, 0}, {1, 0, 0}, {0, side, 0}, light_xml(radiance) + diffuse_xml(0)));
    const Color<double> mean = render(loaded.scene, render_settings("mis", 4, 2, 1)).film.mean();
    EXPECT_EQ(mean.r, side > 0 ? radiance : 0);
  }
}

}  // namespace
}  // namespace etendue

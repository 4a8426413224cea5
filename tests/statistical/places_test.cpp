// Places that floats tell apart badly: near surfaces, far cameras, scenes far from the origin, tiny and huge
// ones, and paths of thousands of vertices. What is right does not depend on any of it.
//
// False-alarm rate of this file: 1e-5 (Sidak over all its t-tests), fixed seeds.
// Seen to fail when: rays start at the surface itself (half of them meet it again), or off it by 1e-5 of the
// largest coordinate; shadow segments end at 1 - 1e-4, or on the light itself; a far scene stays where the
// file has it; rays start at a far camera; a two-sided light is sampled on its front only, or met there only;
// a receiver inside of a sphere light has a density of 0; directions are not made unit after scattering.
#include "film_statistics.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 500;  // At least as many t-tests as are made below.

/// The mean over the image against an exact value. \param tolerance beside the t-test's, relative
void expect_mean(const Scene& scene, std::string_view integrator, int samples, double exact, double tolerance,
                 const std::string& what) {
  const RenderResult result = render(scene, render_settings(integrator, samples, 8, 77));
  EXPECT_EQ(result.invalid.count(), 0) << what;
  const RunningStatistics pixels = statistics_of_pixels(result.film, &Color<double>::g);
  const MeanTest test = t_test(pixels, exact, exact * exact * tolerance * tolerance);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << what << ", " << integrator << ": " << pixels.mean << " +- " << pixels.standard_error() << ", exact "
      << exact;
}

const std::string glass =
    "<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"1.5\"/><float name=\"extIOR\" "
    "value=\"1\"/></bsdf>";
std::string turned_xml(double radiance) {
  return fmt::format(
      "<luminaire type=\"area\"><color name=\"radiance\" value=\"{}\"/><boolean name=\"twosided\" "
      "value=\"true\"/></luminaire>",
      radiance);
}
/// So that a camera far away has it in its clip planes.
std::string clip_xml(double near, double far) {
  return fmt::format("<float name=\"nearClip\" value=\"{}\"/><float name=\"farClip\" value=\"{}\"/>", near,
                     far);
}

/// Two faces of glass over a lamp: (1 - R) / (1 + R) of it comes through, R = 0.04 at normal incidence.
TEST(ThinPane, IsSeenFromAnyDistanceAndAnywhere) {
  constexpr double thickness = 0.004;
  for (const double distance : {2.0, 500.0, 1e4, 1e5})
    for (const double far : {0.0, 1e3, 1e5, 1e7})
      for (const Vec3d& up : {Vec3d{0, 0, 1}, normalize(Vec3d{0.3, 0.5, 0.8})}) {
        const Vec3d at = Vec3d{1, -0.6, 0.3} * far, u = normalize(cross(up, Vec3d{0.1, 1, 0})),
                    v = cross(up, u);
        const auto plate = [&](double height, double sign, const std::string& inside) {
          return rectangle_xml(at + up * height, u * 3, v * (3 * sign), inside);
        };
        const Scene scene = load_scene_text(camera_xml(at + up * distance, at, 30 / distance, 8, "sobol",
                                                       clip_xml(1e-3, 1e6)) +
                                            plate(0, 1, glass) + plate(-thickness, -1, glass) +
                                            plate(-1, 1, diffuse_xml(0) + light_xml(1)))
                                .scene;
        expect_mean(scene, "path_mis", 256, 0.96 / 1.04, 1e-3,
                    fmt::format("pane from {} m, {} m from the origin, up {}", distance, far, text_of(up)));
      }
}

/// A lamp close above a floor, seen from the side, and the same with all lengths and places scaled.
TEST(LowLamp, GivesTheSameLightAtAnyScaleAndPlace) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const double far : {0.0, 10.0, 1e3, 1e5}) {
      const Vec3d at = Vec3d{0.6, 1, -0.4} * (far * scale);
      const Vec3d x = Vec3d{1, 0, 0} * scale, y = Vec3d{0, 1, 0} * scale, z = Vec3d{0, 0, 1} * scale;
      const Vec3d lamp = at + z * 0.02;
      const Scene scene =
          load_scene_text(camera_xml(at + x * 2 + z * 0.004, at, 1e-4, 4, "independent",
                                     clip_xml(1e-3 * scale, 10 * scale)) +
                          rectangle_xml(at, x * 3, y * 3, diffuse_xml(1)) +
                          rectangle_xml(lamp, y * 0.5, x * 0.5, diffuse_xml(0) + light_xml(1)))
              .scene;
      const double exact = polygon_irradiance(rectangle_corners({0, 0, 0.02}, {0, 0.5, 0}, {0.5, 0, 0}), 1,
                                              {0, 0, 0}, {0, 0, 1}) /
                           std::numbers::pi;
      for (const char* integrator : {"light", "direct", "mis", "path_mis"})
        expect_mean(scene, integrator, 4096, exact, 1e-3, fmt::format("scale {}, {} sizes away", scale, far));
    }
}

/// Nothing passes a closed shutter, however near to the lamp; all of the light passes clear air.
TEST(Shutter, HidesTheLampJustBehindIt) {
  for (const auto& [height, gap] : {std::pair{2.0, 0.0005}, {100.0, 0.005}, {1000.0, 0.05}, {1e5, 5.0}})
    for (const bool is_there : {true, false}) {
      const Scene scene =
          load_scene_text(
              camera_xml({1, 0, 1}, {0, 0, 0}, 1e-3, 4, "sobol") +
              rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, diffuse_xml(1)) +
              rectangle_xml({0, 0, height}, {0, 0.5, 0}, {0.5, 0, 0},
                            diffuse_xml(0) + light_xml(height * height)) +
              (is_there ? rectangle_xml({0, 0, height - gap}, {0.6, 0, 0}, {0, 0.6, 0}, diffuse_xml(0)) : ""))
              .scene;
      const double exact = polygon_irradiance(rectangle_corners({0, 0, height}, {0, 0.5, 0}, {0.5, 0, 0}),
                                              height * height, {0, 0, 0}, {0, 0, 1}) /
                           std::numbers::pi;
      for (const char* integrator : {"light", "mis"}) {
        const std::string what = fmt::format("lamp at {}, shutter {} before it", height, gap);
        if (!is_there) {
          expect_mean(scene, integrator, 256, exact, 1e-4, what);
          continue;
        }
        const RenderResult result = render(scene, render_settings(integrator, 256, 8, 3));
        EXPECT_EQ(statistics_of_pixels(result.film, &Color<double>::g).mean, 0) << what;
      }
    }
}

/// Floors on both sides of a lamp get the same light where it is two-sided.
TEST(TwosidedLight, ShinesFromBothSides) {
  const double exact =
      polygon_irradiance(rectangle_corners({0, 0, 1}, {0, 0.5, 0}, {0.5, 0, 0}), 2, {0, 0, 0}, {0, 0, 1}) /
      std::numbers::pi;
  const std::string square = polygon_obj({{-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1}});
  const std::string lamps[] = {
      rectangle_xml({0, 0, 1}, {0, 0.5, 0}, {0.5, 0, 0}, diffuse_xml(0) + turned_xml(2)),
      rectangle_xml({0, 0, 1}, {0.5, 0, 0}, {0, 0.5, 0}, diffuse_xml(0) + turned_xml(2)),
      mesh_xml("square.obj", diffuse_xml(0) + turned_xml(2))};
  for (const std::string& lamp : lamps) {
    const LoadedScene loaded =
        load_scene_text(camera_xml({1, 0, 1}, {0, 0, 0}, 1e-3, 4, "independent") +
                            rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, diffuse_xml(1)) + lamp,
                        {{"square.obj", square}});
    EXPECT_NEAR(loaded.scene.lights.power(0), 2 * 2 * std::numbers::pi, 1e-5);
    EXPECT_EQ(loaded.scene.lights.bounds(0)->cos_normals, -1);
    for (const char* integrator : {"light", "direct", "mis"})
      expect_mean(loaded.scene, integrator, 4096, exact, 1e-5, "two-sided");
  }
}

/// Inside of a sphere that shines inwards the radiance is the same from everywhere.
TEST(TwosidedLight, LightsTheInsideOfASphere) {
  const Scene scene = load_scene_text(camera_xml({1, 0, 0.5}, {0.2, 0, 0}, 20, 4, "independent") +
                                      rectangle_xml({0.2, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, diffuse_xml(0.7)) +
                                      sphere_xml({0, 0, 0}, 3, diffuse_xml(0) + turned_xml(2)))
                          .scene;
  for (const char* integrator : {"light", "direct", "mis"})
    expect_mean(scene, integrator, 4096, 1.4, 1e-5, "in a sphere");
}

/// A white cloud under a white sky cannot be seen, however forward or backward it scatters.
TEST(LongPaths, InACloudKeepTheirDirectionsUnit) {
  for (const double g : {-0.95, -0.7, 0.0, 0.7, 0.95}) {
    const Scene scene =
        load_scene_text(
            camera_xml({0.5, 0.5, 3}, {0.5, 0.5, 0.5}, 10, 8, "independent") +
            sphere_xml({50, 50, 50}, 0.01, diffuse_xml(1)) +
            fmt::format("<emitter type=\"constant\"/><medium type=\"homogeneous\"><color name=\"sigmaA\" "
                        "value=\"0\"/><color name=\"sigmaS\" value=\"30\"/><phase type=\"hg\"><float "
                        "name=\"g\" value=\"{}\"/></phase></medium>",
                        g))
            .scene;
    expect_mean(scene, "path_mats", 256, 1, 1e-4, fmt::format("cloud of g = {}", g));
  }
}

/// Between mirrors that reflect all, and through glass, paths lose nothing in thousands of vertices but what
/// roulette takes and gives back.
TEST(LongPaths, BetweenMirrorsAndInGlassLoseNothing) {
  const std::string mirror = "<bsdf type=\"mirror\"/>";
  const Vec3d x{1.1, 0, 0}, y{0, 1.1, 0}, z{0, 0, 1.1};
  const std::string room = rectangle_xml({0, 0, -1}, x, y, mirror) + rectangle_xml({0, 0, 1}, y, x, mirror) +
                           rectangle_xml({-1, 0, 0}, y, z, mirror) + rectangle_xml({1, 0, 0}, z, y, mirror) +
                           rectangle_xml({0, -1, 0}, z, x, mirror) + rectangle_xml({0, 1, 0}, x, z, mirror);
  // Roulette lets 99 % go on: more must end at the lamp, or the variance would have no bound.
  const std::string lamp =
      rectangle_xml({0, 0, -0.9}, {0.8, 0, 0}, {0, 0.8, 0}, diffuse_xml(0) + turned_xml(1));
  const std::string camera = camera_xml({-0.3, 0.1, 0.2}, {0.9, 0.4, -0.3}, 40, 16, "independent");
  expect_mean(load_scene_text(camera + room + lamp).scene, "path_mats", 1024, 1, 1e-4, "mirrors");
  expect_mean(load_scene_text(camera + room + lamp + sphere_xml({0.1, -0.2, 0.1}, 0.3, glass)).scene,
              "path_mats", 1024, 1, 1e-4, "mirrors and a ball of glass");
}

}  // namespace
}  // namespace etendue

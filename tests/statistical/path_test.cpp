// Path integrators: they agree with each other, and with what is exactly known of furnaces, halls of mirrors,
// glass and media.
//
// False-alarm rate of this file: 1e-5 (Sidak over all its t-tests), fixed seeds.
// Seen to fail when: roulette does not divide by its probability, or ends 1 % more paths than it says; eta is
// left out of roulette; light that a ray off a mirror or through glass meets counts for nothing in path_ems,
// or all that rays meet counts there; refraction leaves radiance as it is; all vertices share one BSDF
// sample; shadow rays pass through the medium undimmed, or its samples are not weighted, or by the density of
// one channel alone; scattering in the medium has a cosine; Henyey and Greenstein's g has the wrong sign;
// several light or BSDF samples are not divided by their number, or their weights do not count them, on
// either side; of several paths from the first vertex roulette sees the shares, not the paths; the pmf of
// another light than the one met is in its density; every_light divides by the number of lights; the medium
// is cut off at the sphere around the shapes; whitted goes on from every surface.
#include "film_statistics.h"
#include "image/image_file.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <optional>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 4000;  // At least as many t-tests as are made below.

Film rendered(const Scene& scene, RenderSettings settings, const std::string& what) {
  RenderResult result = render(scene, settings);
  EXPECT_EQ(result.invalid.count(), 0) << what;
  return std::move(result.film);
}
Film rendered(const Scene& scene, std::string_view integrator, int samples, std::uint64_t seed,
              const std::string& what = "") {
  return rendered(scene, render_settings(integrator, samples, 4, seed), what);
}

struct Method {
  const char* integrator;
  int samples;  ///< A pixel: those that find lights by chance need more to be normally distributed.
};

/// Holds two films against each other in blocks of 16 x 16 pixels.
void expect_equal_means(const Film& a, const Film& b, const std::string& what) {
  constexpr int block_px = 16;
  for (int y = 0; y < a.height(); y += block_px)
    for (int x = 0; x < a.width(); x += block_px)
      for (const Channel64 channel : channels64) {
        const RunningStatistics first = block_mean(a, x, y, block_px, channel),
                                second = block_mean(b, x, y, block_px, channel);
        const MeanTest test = welch_t_test(first, second);
        EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
            << what << ", block at " << x << ", " << y << ": " << first.mean << " +- "
            << first.standard_error() << " against " << second.mean << " +- " << second.standard_error()
            << ", p = " << test.p_value;
      }
}

/// Each of `methods` against the first.
void expect_agreement(const Scene& scene, std::initializer_list<Method> methods, const std::string& what) {
  std::optional<Film> first;
  std::uint64_t seed = 200;
  for (const Method& method : methods) {
    // Another seed for each: the test wants independent estimates.
    Film film = rendered(scene, method.integrator, method.samples, ++seed, what);
    if (first)
      expect_equal_means(film, *first, what + ", " + method.integrator);
    else
      first = std::move(film);
  }
}

/// All pixels together against one exact value; no closer than 3e-5 of it, where what scatters is too rare to
/// be normally distributed (the end of a path that goes on with probability 0.99). \param most_error largest
/// standard error, relative: a test that could not fail is none
void expect_mean(const Film& film, const Color<double>& exact, double most_error, const std::string& what) {
  for (const Channel64 channel : channels64) {
    const RunningStatistics pixels = statistics_of_pixels(film, channel);
    const double value = exact.*channel;
    const MeanTest test = t_test(pixels, value, value * value * 1e-6);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << what << ": " << pixels.mean << " +- " << pixels.standard_error() << ", exact " << value << ", "
        << test.statistic << " standard errors";
    EXPECT_LT(pixels.standard_error(), most_error * value) << what;
  }
}

/// Every pixel, but for rounding: nothing is random here.
void expect_pixels(const Film& film, const Color<double>& exact, const std::string& what) {
  for (const Channel64 channel : channels64)
    for (int i = 0; i < film.width(); ++i)
      ASSERT_NEAR(film.at(i, i).mean.*channel / (exact.*channel), 1, 3e-5) << what << ", pixel " << i;
}

Color<double> grey(double value) { return {value, value, value}; }
Color<double> map(const Color<double>& c, const std::function<double(double)>& f) {
  return {f(c.r), f(c.g), f(c.b)};
}
std::string text_of(const Color<double>& c) { return fmt::format("{},{},{}", c.r, c.g, c.b); }

std::string coloured_xml(const Color<double>& albedo) {
  return fmt::format("<bsdf type=\"diffuse\"><color name=\"albedo\" value=\"{}\"/></bsdf>", text_of(albedo));
}
std::string glass_xml(double index) {
  return fmt::format(
      "<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"{}\"/><float name=\"extIOR\" value=\"1\"/>"
      "</bsdf>",
      index);
}
const std::string mirror = "<bsdf type=\"mirror\"/>";
std::string constant_xml(const Color<double>& radiance) {
  return fmt::format("<emitter type=\"constant\"><color name=\"radiance\" value=\"{}\"/></emitter>",
                     text_of(radiance));
}
std::string point_light_xml(const Vec3d& position, double intensity) {
  return fmt::format(
      "<emitter type=\"point\"><point name=\"position\" value=\"{}\"/><color name=\"intensity\" "
      "value=\"{}\"/></emitter>",
      text_of(position), intensity);
}

/// A medium in the box from `low` to `high`.
std::string medium_xml(const Color<double>& absorption, const Color<double>& scattering, double g = 0,
                       const Vec3d& low = {0, 0, 0}, const Vec3d& high = {1, 1, 1}) {
  return fmt::format(
      "<medium type=\"homogeneous\"><color name=\"sigmaA\" value=\"{}\"/><color name=\"sigmaS\" "
      "value=\"{}\"/><transform name=\"toWorld\"><scale value=\"{}\"/><translate value=\"{}\"/></transform>"
      "<phase type=\"hg\"><float name=\"g\" value=\"{}\"/></phase></medium>",
      text_of(absorption), text_of(scattering), text_of(high - low), text_of(low), g);
}

/// The six walls of the room [-1, 1]^3, facing inward; they overlap, so that nothing leaks through the edges.
/// \param inside of the floor, the ceiling, left, right, back, front
std::string room_xml(const std::array<std::string, 6>& inside) {
  const Vec3d x{1.1, 0, 0}, y{0, 1.1, 0}, z{0, 0, 1.1};
  return rectangle_xml({0, 0, -1}, x, y, inside[0]) + rectangle_xml({0, 0, 1}, y, x, inside[1]) +
         rectangle_xml({-1, 0, 0}, y, z, inside[2]) + rectangle_xml({1, 0, 0}, z, y, inside[3]) +
         rectangle_xml({0, 1, 0}, x, z, inside[4]) + rectangle_xml({0, -1, 0}, z, x, inside[5]);
}
std::string room_xml(const std::string& inside) {
  return room_xml({inside, inside, inside, inside, inside, inside});
}
std::string room_camera_xml(int side_px) {
  return camera_xml({0.1, -0.95, 0.05}, {0, 1, -0.1}, 80, side_px, "independent");
}

// --- They agree ---

std::string coloured_room_xml(int side_px) {
  const std::string white = diffuse_xml(0.6);
  return room_camera_xml(side_px) +
         room_xml(
             {white, white, coloured_xml({0.6, 0.1, 0.1}), coloured_xml({0.1, 0.6, 0.1}), white, white}) +
         rectangle_xml({0, 0.1, 0.98}, {0.4, 0, 0}, {0, -0.4, 0}, light_xml(5));
}

TEST(PathsAgree, InAClosedRoomWithAPhongBlock) {
  const LoadedScene loaded =
      load_scene_text(coloured_room_xml(48) + mesh_xml("block.obj", phong_xml(0.3, 0.5, 30)),
                      {{"block.obj", box_obj({0.35, 0.3, -0.6}, 0.35, false)}});
  expect_agreement(loaded.scene, {{"path_mis", 256}, {"path_ems", 256}, {"path_mats", 512}}, "room");
}

TEST(PathsAgree, WithAMirrorAndGlass) {
  // A light sample never goes through glass, and no density says how a mirror's ray was found: the light that
  // such a ray meets has to count whole, in path_ems and path_mis as in path_mats.
  const LoadedScene loaded =
      load_scene_text(coloured_room_xml(48) + sphere_xml({0.45, 0.2, -0.6}, 0.4, glass_xml(1.5)) +
                      rectangle_xml({-0.5, 0.6, -0.4}, {0.4, 0.2, 0}, {0, 0, 0.6}, mirror));
  expect_agreement(loaded.scene, {{"path_mats", 1024}, {"path_mis", 512}, {"path_ems", 512}},
                   "mirror, glass");
}

TEST(PathsAgree, UnderAnEnvironmentMapAndAPointLight) {
  const test::TemporaryFolder folder;
  Image map{8, 4, {{"B", {}}, {"G", {}}, {"R", {}}}, {}};
  for (std::size_t c = 0; c < 3; ++c)
    for (int i = 0; i < 32; ++i) map.channels[c].values.push_back(0.2f + 0.1f * float(c) + (i == 11 ? 8 : 0));
  write_exr(folder.path() / "map.exr", map);
  const std::string lights = point_light_xml({1, -1, 2}, 4) +
                             "<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
                             (folder.path() / "map.exr").string() + "\"/></emitter>";
  const LoadedScene loaded =
      load_scene_text(camera_xml({0, -4, 2}, {0, 0, 0.4}, 40, 48, "independent") +
                      rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, coloured_xml({0.7, 0.5, 0.3})) + lights +
                      sphere_xml({-0.7, 0, 0.6}, 0.6, phong_xml(0.3, 0.5, 50)) +
                      sphere_xml({0.7, 0.2, 0.6}, 0.6, glass_xml(1.5)));
  expect_agreement(loaded.scene, {{"path_mis", 512}, {"path_ems", 512}}, "environment map and point light");
}

TEST(PathsAgree, HoweverManyLeaveTheFirstVertex) {
  const std::string room = coloured_room_xml(48) + mesh_xml("block.obj", phong_xml(0.3, 0.5, 30)) +
                           sphere_xml({-0.5, 0.2, -0.6}, 0.35, glass_xml(1.5)),
                    mist = medium_xml({0.1, 0.2, 0.1}, {0.1, 0.2, 0.3}, 0.3, {-1, -1, -1}, {1, 1, 1});
  for (const std::string& more : {std::string(), mist}) {
    const LoadedScene loaded =
        load_scene_text(room + more, {{"block.obj", box_obj({0.35, 0.3, -0.6}, 0.35, false)}});
    const Film reference = rendered(loaded.scene, "path_mis", 512, 300);
    std::uint64_t seed = 300;
    for (const Method& method : {Method{"path", 512}, {"path_mis", 512}, {"path_mats", 1024}})
      for (const int paths : {1, 2, 4}) {
        RenderSettings settings = render_settings(method.integrator, method.samples / paths, 4, ++seed);
        settings.integrator = with_bsdf_samples(settings.integrator, paths);
        const std::string what = fmt::format("{}, {} paths", method.integrator, paths);
        expect_equal_means(rendered(loaded.scene, settings, what), reference, what);
      }
  }
}

// --- Closed forms without a medium ---

TEST(PathRoulette, LetsAsManyPathsGoOnAsItSays) {
  // In a closed room of albedo a the throughput at the third vertex is a^3, and each path that goes on from
  // there, in proportion to it, does so again with probability a: 1 + 1 + factor a^3 / (1 - a) rays.
  const double albedo = 0.5;
  const LoadedScene loaded =
      load_scene_text(room_camera_xml(32) + room_xml(light_xml(1) + diffuse_xml(albedo)));
  for (const auto& [integrator, factor] : {std::pair{"path_mis", 1.0}, {"path_mats", 1.0}, {"path", 2.0}})
    for (const int paths : {1, 4}) {
      RenderSettings settings = render_settings(integrator, 128, 4, 9);
      settings.integrator = with_bsdf_samples(settings.integrator, paths);
      const RenderResult result = render(loaded.scene, settings);
      const double rays = double(result.counts.bsdf_rays) / double(result.counts.samples) / paths,
                   exact = 2 + factor * std::pow(albedo, 3) / (1 - albedo);
      const double most_error = 0.01;  // 5 standard errors of one path.
      EXPECT_NEAR(rays, exact, most_error) << integrator << ", " << paths << " paths";
    }
}

TEST(PathFurnace, AGlowingRoomShinesAsTheGeometricSeries) {
  // path_ems has no place here: in a corner of two lights its samples have no bound.
  for (const double albedo : {0.0, 0.3, 0.7, 0.98}) {
    const LoadedScene loaded =
        load_scene_text(room_camera_xml(32) + room_xml(light_xml(1) + diffuse_xml(albedo)));
    for (const char* integrator : {"path_mats", "path_mis"})
      expect_mean(rendered(loaded.scene, integrator, 64, 3), grey(1 / (1 - albedo)), 0.01,
                  fmt::format("{}, albedo {}", integrator, albedo));
  }
}

TEST(PathFurnace, WallsInEquilibriumAllLookAlike) {
  // Kirchhoff's law: each wall glows with what it does not reflect. A mirror and glass change nothing.
  const auto wall = [](double albedo) { return light_xml(1 - albedo) + diffuse_xml(albedo); };
  const LoadedScene loaded = load_scene_text(
      room_camera_xml(32) + room_xml({wall(0.2), wall(0.9), wall(0.5), mirror, wall(0.7), wall(0.4)}) +
      sphere_xml({0.3, 0.2, -0.4}, 0.4, glass_xml(1.5)));
  for (const char* integrator : {"path_mats", "path_mis"})
    expect_mean(rendered(loaded.scene, integrator, 256, 4), grey(1), 0.005, integrator);
}

/// Walls that reflect all light around a black sphere that shines: what is seen is its radiance, everywhere.
void expect_hall_to_shine(const std::array<std::string, 6>& walls, const std::string& more,
                          std::initializer_list<Method> methods, const std::string& what) {
  const LoadedScene loaded = load_scene_text(room_camera_xml(32) + room_xml(walls) + more +
                                             sphere_xml({0.2, 0.3, 0.1}, 0.6, light_xml(2) + diffuse_xml(0)));
  for (const Method& method : methods)
    expect_mean(rendered(loaded.scene, method.integrator, method.samples, 5), grey(2), 0.005,
                what + ", " + method.integrator);
}

TEST(PathHall, OfPerfectMirrorsEnds) {
  expect_hall_to_shine({mirror, mirror, mirror, mirror, mirror, mirror}, "",
                       {{"path_mats", 64}, {"path_mis", 64}, {"path_ems", 64}, {"whitted", 64}}, "mirrors");
}

TEST(PathHall, OfWhiteWallsMirrorsAndGlass) {
  const std::string white = diffuse_xml(1);
  expect_hall_to_shine({white, white, white, white, white, white}, "",
                       {{"path_mats", 256}, {"path_mis", 256}, {"path_ems", 256}}, "white");
  expect_hall_to_shine({white, mirror, white, white, mirror, white},
                       sphere_xml({-0.6, -0.3, -0.6}, 0.35, glass_xml(1.5)),
                       {{"path_mats", 256}, {"path_mis", 512}, {"path_ems", 512}}, "white, mirrors, glass");
}

TEST(PathGlass, IsInvisibleInAConstantEnvironment) {
  const Color<double> sky{1, 2, 3};
  for (const double index : {0.7, 1.5, 2.4})
    for (const std::string& shape :
         {sphere_xml({0, 0, 0}, 1, glass_xml(index)), mesh_xml("slab.obj", glass_xml(index))}) {
      const LoadedScene loaded = load_scene_text(
          camera_xml({0.5, -3, 1.5}, {0, 0, 0}, 40, 32, "independent") + shape + constant_xml(sky),
          {{"slab.obj", box_obj({0, 0, 0}, 0.7, false)}});
      for (const char* integrator : {"path_mats", "path_mis", "path_ems", "whitted"}) {
        // A cube with total reflection keeps some paths in for good: what roulette then pays out is rare.
        const double most_error = 0.002;
        expect_mean(rendered(loaded.scene, integrator, 64, 6), sky, most_error,
                    fmt::format("{}, index {}", integrator, index));
      }
    }
}

TEST(PathGlass, RadianceWithinIsThatOutsideTimesTheIndexSquared) {
  // From inside a sphere, so near its centre that nothing is totally reflected.
  const double index = 1.6;
  const LoadedScene loaded =
      load_scene_text(camera_xml({0.3, 0.2, 0.1}, {1, 1, 0.2}, 60, 32, "independent") +
                      sphere_xml({0, 0, 0}, 1, glass_xml(index)) + constant_xml(grey(1)));
  for (const char* integrator : {"path_mats", "path_mis", "path_ems", "whitted"})
    expect_mean(rendered(loaded.scene, integrator, 64, 7), grey(index * index), 0.002, integrator);
}

TEST(PathGlass, DoesNotMakeRouletteWild) {
  // Within a glass the radiance of the sky is index^2, and a path's throughput 1 / index^2: no reason to end
  // it. Where it were one, samples would be 0 or far above 1.
  const LoadedScene loaded = load_scene_text(
      camera_xml({0, -3, 0}, {0, 0, 0}, 20, 16, "independent") + sphere_xml({0, 0, 0}, 1, glass_xml(2.4)) +
      sphere_xml({0, 0, 0}, 0.8, glass_xml(1.2)) + constant_xml(grey(1)));
  const Film film = rendered(loaded.scene, render_settings("path_mats", 256, 256, 8), "nested glass");
  RunningStatistics variance;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) variance.add(film.at(x, y).m2.g / 255);
  EXPECT_LT(variance.mean, 0.15);  // 0.99^-n for a few n.
}

// --- Media ---

const Color<double> coloured{0.2, 1, 3};
const std::string through_camera = camera_xml({0.5, -3, 0.5}, {0.5, 0, 0.5}, 0.01, 8, "independent");
constexpr const char* all_integrators[]{"light",   "direct",   "average",   "mis",     "every_light",
                                        "whitted", "path_mis", "path_mats", "path_ems"};
constexpr const char* light_integrators[]{"light",   "average",  "mis",     "every_light",
                                          "whitted", "path_mis", "path_ems"};

TEST(PathMedium, BeerAndLambertDimWhatTheCameraSees) {
  const Color<double> transmittance = map(coloured, [](double sigma) { return std::exp(-sigma); });
  const std::string lamp = rectangle_xml({0.5, 3, 0.5}, {1, 0, 0}, {0, 0, 1}, light_xml(1) + diffuse_xml(0));
  const std::string nothing = sphere_xml({0, 0, 9}, 0.1, diffuse_xml(0));
  for (const std::string& light : {lamp, nothing + constant_xml(grey(1))}) {
    const LoadedScene loaded = load_scene_text(through_camera + light + medium_xml(coloured, grey(0)));
    for (const char* integrator : all_integrators)
      expect_pixels(rendered(loaded.scene, integrator, 8, 1), transmittance, integrator);
  }
}

TEST(PathMedium, BeerAndLambertDimTheLightOnTheWayToAFloor) {
  const double intensity = 5, albedo = 0.6;
  const LoadedScene loaded =
      load_scene_text(camera_xml({3, 0, -0.5}, {0.5, 0.5, -1}, 0.01, 8, "independent") +
                      rectangle_xml({0.5, 0.5, -1}, {2, 0, 0}, {0, 2, 0}, diffuse_xml(albedo)) +
                      point_light_xml({0.5, 0.5, 2}, intensity) + medium_xml(coloured, grey(0)));
  for (const char* integrator : light_integrators)
    expect_pixels(
        rendered(loaded.scene, integrator, 8, 1),
        map(coloured,
            [&](double sigma) { return std::exp(-sigma) * albedo / std::numbers::pi * intensity / 9; }),
        integrator);
}

/// Midpoint rule.
double integral(double from, double to, const std::function<double(double)>& f) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(from + (to - from) * (i + 0.5) / steps);
  return sum * (to - from) / steps;
}

TEST(PathMedium, DimsLightFromInfinityAllTheWayThroughWhereItReachesBeyondAllShapes) {
  // A floor deep in a layer, 1.5 below its top, and a camera 0.1 above the floor.
  const std::string scene = camera_xml({0, 0, 0.1}, {0, 0, 0}, 0.1, 16, "independent",
                                       "<float name=\"nearClip\" value=\"1e-6\"/>") +
                            rectangle_xml({0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, diffuse_xml(1)) +
                            medium_xml(coloured, grey(0), 0, {-100, -100, -1}, {100, 100, 1.5});
  const LoadedScene sun = load_scene_text(
      scene +
      "<emitter type=\"directional\"><color name=\"irradiance\" value=\"1\"/><vector name=\"direction\" "
      "value=\"0,0,-1\"/></emitter>");
  for (const char* integrator : light_integrators)
    expect_pixels(rendered(sun.scene, integrator, 8, 1),
                  map(coloured, [](double sigma) { return std::exp(-sigma * 1.6) / std::numbers::pi; }),
                  std::string("directional, ") + integrator);
  const LoadedScene sky = load_scene_text(scene + constant_xml(grey(1)));
  const Color<double> exact = map(coloured, [](double sigma) {
    return std::exp(-sigma * 0.1) * 2 *
           integral(0, 1, [&](double cosine) { return cosine * std::exp(-1.5 * sigma / cosine); });
  });
  for (const char* integrator : all_integrators)
    expect_mean(rendered(sky.scene, integrator, 1024, 2), exact, 0.01, std::string("sky, ") + integrator);
}

TEST(PathMedium, ScattersOnceAsTheQuadratureSays) {
  // The camera looks along the y axis through the middle of the cube; the light is above it.
  const Vec3d light{0.4, 0.3, 2};
  const double intensity = 5;
  const Color<double> absorption{0.1, 0.2, 0.4}, scattering{0.2, 0.6, 1.5};
  for (const double g : {0.0, 0.6, -0.4}) {
    const LoadedScene loaded =
        load_scene_text(camera_xml({0.5, -3, 0.5}, {0.5, 0, 0.5}, 0.001, 32, "independent") +
                        rectangle_xml({0.5, 3, 0.5}, {1, 0, 0}, {0, 0, 1}, diffuse_xml(0)) +
                        point_light_xml(light, intensity) + medium_xml(absorption, scattering, g));
    const auto exact = [&](Channel64 channel) {
      const double sigma_s = scattering.*channel, sigma_t = sigma_s + absorption.*channel;
      return integral(0, 1, [&](double y) {
        const Vec3d to_light = light - Vec3d{0.5, y, 0.5};
        const double distance = length(to_light), cosine = to_light.y / distance;
        const double phase = (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        // The way to the light leaves the cube through its top, after a third of it.
        return sigma_s * std::exp(-sigma_t * (y + distance / 3)) * phase * intensity / (distance * distance);
      });
    };
    const Color<double> radiance{exact(&Color<double>::r), exact(&Color<double>::g),
                                 exact(&Color<double>::b)};
    for (const char* integrator : {"light", "average", "mis", "every_light"})
      expect_mean(rendered(loaded.scene, integrator, 1024, 9), radiance, 0.005,
                  fmt::format("{}, g = {}", integrator, g));
  }
}

TEST(PathMedium, ThatAbsorbsNothingIsInvisibleInAConstantEnvironment) {
  for (const double g : {0.0, 0.8, -0.5})
    for (const Color<double>& scattering : {grey(2), Color<double>{0.5, 1, 3}}) {
      const LoadedScene loaded =
          load_scene_text(camera_xml({0.2, -2, 1.5}, {0.5, 0.5, 0.5}, 40, 32, "independent") +
                          sphere_xml({0.6, 0.5, 0.4}, 0.25, diffuse_xml(1)) + constant_xml(grey(1)) +
                          medium_xml(grey(0), scattering, g));
      for (const char* integrator : {"path_mats", "path_mis", "path_ems"})
        expect_mean(rendered(loaded.scene, integrator, 128, 10), grey(1), 0.02,
                    fmt::format("{}, g = {}, blue {}", integrator, g, scattering.b));
    }
}

TEST(PathMedium, AColouredOneIsAGreyOneInEachChannel) {
  const auto load = [](const Color<double>& absorption, const Color<double>& scattering) {
    return load_scene_text(camera_xml({0.2, -2, 1.5}, {0.5, 0.5, 0.4}, 40, 48, "independent") +
                           rectangle_xml({0.5, 0.5, -0.01}, {1, 0, 0}, {0, 1, 0}, diffuse_xml(0.7)) +
                           rectangle_xml({0.5, 0.5, 1.6}, {0.4, 0, 0}, {0, -0.4, 0}, light_xml(5)) +
                           medium_xml(absorption, scattering, 0.3));
  };
  const Color<double> absorption{0.1, 0.5, 0}, scattering{0.5, 0, 3};
  const LoadedScene all = load(absorption, scattering);
  const Film film = rendered(all.scene, "path_mis", 256, 11);
  Film greys(film.width(), film.height());
  for (const Channel64 channel : channels64) {
    const LoadedScene one = load(grey(absorption.*channel), grey(scattering.*channel));
    const Film part = rendered(one.scene, "path_mis", 256, 12);
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) {
        PixelStatistics& pixel = greys.at(x, y);
        pixel.count = part.at(x, y).count;
        pixel.mean.*channel = part.at(x, y).mean.*channel;
        pixel.m2.*channel = part.at(x, y).m2.*channel;
      }
  }
  expect_equal_means(film, greys, "coloured and grey");
  expect_agreement(all.scene, {{"path_mis", 256}, {"path_ems", 256}, {"path_mats", 1024}}, "coloured");
}

// --- Direct light in other ways ---

/// A floor under four lights of different kinds. \param more inside of the scene
LoadedScene four_lights(const std::string& more = "") {
  return load_scene_text(camera_xml({0, -4, 2}, {0, 0, 0.3}, 40, 48, "independent") +
                         rectangle_xml({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, phong_xml(0.4, 0.3, 20)) +
                         sphere_xml({0.3, 0, 0.5}, 0.5, phong_xml(0.2, 0.6, 60)) +
                         rectangle_xml({-1, 0.5, 1.5}, {0.4, 0, 0}, {0, -0.4, 0}, light_xml(5)) +
                         sphere_xml({1.3, 0.5, 1}, 0.3, light_xml(4)) + constant_xml({0.1, 0.2, 0.3}) +
                         point_light_xml({0, -1, 2}, 2) + more);
}

TEST(DirectLight, OfEveryLightIsThatOfOneAtRandom) {
  expect_agreement(four_lights().scene, {{"every_light", 128}, {"light", 512}, {"mis", 512}}, "every light");
}

/// Lights of very unequal power, of which BSDF samples find all but the point: where the pmf in the density
/// of a light that a ray has met is not that of its choice, weights do not add up to 1.
TEST(DirectLight, IsTheSameByEveryLightSampler) {
  const LoadedScene loaded =
      four_lights(rectangle_xml({1.5, -1, 1.8}, {0.5, 0, 0}, {0, -0.5, 0}, light_xml(30)));
  const Film expected = rendered(loaded.scene, render_settings("mis", 1024, 1024, 30), "mis, uniform");
  std::uint64_t seed = 30;
  for (const char* integrator : {"mis", "light", "average"})
    for (const Plugin& sampler : light_sampler_plugins()) {
      RenderSettings settings = render_settings(integrator, 512, 512, ++seed);
      settings.integrator = with_light_sampler(settings.integrator, sampler.name);
      const std::string what = std::string(integrator) + ", " + sampler.name;
      expect_equal_means(rendered(loaded.scene, settings, what), expected, what);
    }
}

RenderSettings several(const DirectLight& direct_light, int samples, std::uint64_t seed) {
  RenderSettings settings = render_settings("mis", samples, samples, seed);
  settings.integrator.rules = PathRules::direct(direct_light);
  return settings;
}

double mean_variance(const Film& film) {
  double sum = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) sum += film.at(x, y).m2.g / double(film.at(x, y).count - 1);
  return sum / (film.width() * film.height());
}

TEST(DirectLight, BySeveralSamplesHasTheSameMeanAndLessVariance) {
  const std::string mist = medium_xml({0.1, 0.2, 0.3}, {0.2, 0.1, 0.1}, 0.5, {-2, -2, -1}, {2, 2, 1.2});
  for (const std::string& medium : {std::string(), mist}) {
    const LoadedScene loaded = four_lights(medium);
    const Film once = rendered(loaded.scene, several(ByBoth{}, 256, 20), "mis");
    const double variance = mean_variance(once);
    struct Case {
      const char* what;
      DirectLight direct_light;
    };
    for (const Case& c : {Case{"mis, 3 and 2", ByBoth{Heuristic::balance, {.count = 3}, 2}},
                          Case{"power, 2 and 3", ByBoth{Heuristic::power, {.count = 2}, 3}},
                          Case{"lights, 3", ByLights{{.count = 3}}}}) {
      const Film film = rendered(loaded.scene, several(c.direct_light, 128, 21), c.what);
      expect_equal_means(film, once, c.what);
      // What the pixel's area and the medium add stays as it is.
      if (std::holds_alternative<ByBoth>(c.direct_light)) {
        EXPECT_LT(mean_variance(film), (medium.empty() ? 0.8 : 0.95) * variance) << c.what;
      }
    }
  }
}

TEST(Whitted, IsLightWithoutMirrorsAndGlass) {
  const LoadedScene loaded = load_scene_text(coloured_room_xml(16));
  EXPECT_EQ(rendered(loaded.scene, "whitted", 16, 31).mean(), rendered(loaded.scene, "light", 16, 31).mean());
}

TEST(Whitted, IsThePathWhereNoDiffuseSurfaceLightsAnother) {
  // Upright panes: light that leaves the floor by way of them goes on upwards. So a path finds no more than
  // what Whitted's recursion does, and with the same random numbers each sample is the same.
  const LoadedScene loaded =
      load_scene_text(camera_xml({0.4, -4, 1.5}, {0, 0, 0.4}, 40, 48, "independent") +
                      rectangle_xml({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, coloured_xml({0.7, 0.5, 0.3})) +
                      rectangle_xml({0, 2, 1}, {2, 0, 0}, {0, 0, 1}, mirror) +
                      rectangle_xml({0, 0, 0.6}, {0.8, 0, 0}, {0, 0, 0.6}, glass_xml(1.5)) +
                      rectangle_xml({0, 0.3, 0.6}, {0.8, 0, 0}, {0, 0, -0.6}, glass_xml(1.5)) +
                      point_light_xml({1, -1, 2}, 3) + point_light_xml({-1, 1, 3}, 5));
  const Film whitted = rendered(loaded.scene, "whitted", 64, 30);
  for (const char* integrator : {"path_ems", "path_mis"}) {
    const Film path = rendered(loaded.scene, integrator, 64, 30);
    EXPECT_NEAR(path.mean().g / whitted.mean().g, 1, 1e-6);
    int different = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x)
        different += std::abs(path.at(x, y).mean.g - whitted.at(x, y).mean.g) > 1e-6;
    EXPECT_EQ(different, 0) << integrator;
  }
  const Film light = rendered(loaded.scene, "light", 64, 30);
  EXPECT_GT(whitted.mean().g, 1.1 * light.mean().g);
}

}  // namespace
}  // namespace etendue

// The integrators that need no lights of the scene against closed forms: normals, av, ao, material, simple.
//
// False-alarm rate of this file: 1e-5 (Sidak over its t-tests), fixed seeds; the rest is exact up to
// rounding. Seen to fail when: normals are geometric; av weighs by the cosine, and ao does not; the length of
// av is not kept, or is twice as long; a miss of av's camera is black; the hemisphere is turned to the
// camera; the factor of simple is 1 / (4 pi), or its shadow ray goes on behind the light.

#include "integrator/unlit.h"

#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <gtest/gtest.h>
#include <numbers>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 100;  // At least as many tests as are made below.
constexpr double pi_d = std::numbers::pi;

std::string integrator_xml(const std::string& name, const std::string& parameters = {}) {
  return fmt::format("<integrator type=\"{}\">{}</integrator>\n", name, parameters);
}
std::string length_xml(double length) { return fmt::format("<float name=\"length\" value=\"{}\"/>", length); }

/// A narrow view of one point; every scene has a light somewhere, which these integrators do not look at.
struct View {
  Vec3d origin, target;
};
RenderResult look(const View& view, const std::string& scene, Isa isa, int samples,
                  const std::vector<SceneFile>& files = {}) {
  const LoadedScene loaded =
      load_scene_text(camera_xml(view.origin, view.target, 1e-3, 1, "independent") + scene, files);
  std::vector<UnreadKey> unread;
  RenderSettings settings;
  settings.integrator = make_integrator(loaded.integrator, Dialect::nori_2012, unread);
  settings.samples_per_pixel = samples;
  settings.replicates = std::min(samples, 64);
  settings.replicates_by = ReplicatesBy::scrambling;
  settings.seed = 3;
  settings.isa = isa;
  RenderResult result = render(loaded.scene, settings);
  EXPECT_EQ(result.invalid.count(), 0);
  EXPECT_TRUE(unread.empty());
  return result;
}

class Unlit : public testing::TestWithParam<Isa> {
 protected:
  void expect_mean(const View& view, const std::string& scene, double exact, const std::string& what,
                   const std::vector<SceneFile>& files = {}) const {
    const RenderResult result = look(view, scene, GetParam(), 1 << 17, files);
    const PixelStatistics& pixel = result.film.at(0, 0);
    const RunningStatistics grey{pixel.count, pixel.mean.g, pixel.m2.g};
    const MeanTest test = t_test(grey, exact, 1e-12);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << what << ": " << grey.mean << " +- " << grey.standard_error() << ", exact " << exact;
    EXPECT_EQ(pixel.mean.r, pixel.mean.g);
    EXPECT_EQ(pixel.mean.b, pixel.mean.g);
  }
  Color<double> color(const View& view, const std::string& scene,
                      const std::vector<SceneFile>& files = {}) const {
    return look(view, scene, GetParam(), 16, files).film.at(0, 0).mean;
  }
};

/// \param relative to the largest channel
void expect_near(const Color<double>& c, const Vec3d& exact, double relative, const std::string& what) {
  const double tolerance = relative * std::max({exact.x, exact.y, exact.z});
  EXPECT_NEAR(c.r, exact.x, tolerance) << what;
  EXPECT_NEAR(c.g, exact.y, tolerance) << what;
  EXPECT_NEAR(c.b, exact.z, tolerance) << what;
}

/// The plane z = height, or a part of it, facing up or down; a light, so that the scene has one.
std::string floor_xml(double half = 1e4) {
  return rectangle_xml({0, 0, 0}, {half, 0, 0}, {0, half, 0}, light_xml(1));
}
std::string ceiling_xml(double height, double half = 1e4) {
  return rectangle_xml({0, 0, height}, {half, 0, 0}, {0, -half, 0}, "");
}
SceneFile disk_file(double radius, double height) {
  std::vector<Vec3d> rim;
  for (int i = 0; i < 720; ++i)
    rim.push_back({radius * std::cos(i * pi_d / 360), radius * std::sin(i * pi_d / 360), height});
  return {"disk.obj", polygon_obj(rim)};
}
constexpr View down{{0, 0, 0.3}, {0, 0, 0}};  // Below all that hides the sky.

TEST_P(Unlit, NormalsOfASphereAreItsDirections) {
  for (const Vec3d& n : {Vec3d{1, 0, 0}, normalize(Vec3d{1, 2, 3}), normalize(Vec3d{-3, 1, -0.2})}) {
    const Vec3d center{0.5, -1, 2};
    const Color<double> c =
        color({center + n * 5, center}, integrator_xml("normals") + sphere_xml(center, 0.7, light_xml(1)));
    expect_near(c, {std::abs(n.x), std::abs(n.y), std::abs(n.z)}, 1e-4, "sphere");
  }
}

TEST_P(Unlit, NormalsAreThoseOfShading) {
  const SceneFile face{"face.obj",
                       "v 1 0 0\nv 0 1 0\nv 0 0 1\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\nf 1//1 2//2 3//3\n"};
  const Vec3d hit = Vec3d{0.6, 0.3, 0.1}, n = normalize(hit);
  expect_near(color({hit * 4, hit}, integrator_xml("normals") + mesh_xml("face.obj", light_xml(1)), {face}),
              {n.x, n.y, n.z}, 1e-4, "smooth triangle");
  expect_near(
      color({{9, 9, 9}, {9, 9, 12}}, integrator_xml("normals") + mesh_xml("face.obj", light_xml(1)), {face}),
      {0, 0, 0}, 0, "miss");
}

TEST_P(Unlit, AverageVisibilityBetweenDisks) {
  // Directions are uniform: the share that passes a coaxial disk is d / sqrt(d^2 + r^2).
  for (const double d : {0.5, 1.0, 2.0}) {
    const SceneFile disk = disk_file(1, d);
    const std::string scene = floor_xml(1) + mesh_xml("disk.obj", "");
    expect_mean(down, integrator_xml("av", length_xml(1000)) + scene, d / std::hypot(d, 1), "disks", {disk});
    expect_mean(down, integrator_xml("av") + scene, d / std::hypot(d, 1), "disks, no limit", {disk});
    expect_mean(down, integrator_xml("av", length_xml(0.999 * d)) + scene, 1, "too far to count", {disk});
  }
}

TEST_P(Unlit, AverageVisibilityKeepsItsLength) {
  // cos theta is uniform, and a ceiling at h is met within the length where cos theta > h / length.
  for (const double length : {1.25, 2.0, 10.0})
    expect_mean(down, integrator_xml("av", length_xml(length)) + floor_xml() + ceiling_xml(1), 1 / length,
                "ceiling within " + std::to_string(length));
  expect_mean({{0, 0, 2}, {0, 0, 5}}, integrator_xml("av") + floor_xml(), 1, "miss");
  // From below, the hemisphere is still that of the normal.
  expect_mean({{0, 0, -2}, {0, 0, 0}}, integrator_xml("av") + floor_xml(), 1, "seen from behind");
  expect_mean({{0, 0, -2}, {0, 0, 0}}, integrator_xml("av") + floor_xml() + ceiling_xml(1), 0,
              "seen from behind, below a ceiling");
}

TEST_P(Unlit, AmbientOcclusion) {
  expect_mean(down, integrator_xml("ao") + floor_xml(), 1, "open sky");
  expect_mean(down, integrator_xml("ao") + floor_xml(10) + ceiling_xml(500, 1e8), 0, "ceiling, however far");
  expect_mean({{0, 0, 2}, {0, 0, 5}}, integrator_xml("ao") + floor_xml(), 0, "miss");
  // The form factor of a coaxial disk is r^2 / (r^2 + d^2).
  expect_mean(down, integrator_xml("ao") + floor_xml() + mesh_xml("disk.obj", ""), 1 - 1 / (1 + 0.64), "disk",
              {disk_file(1, 0.8)});
  // A half-plane that rises from the floor at the angle w leaves (1 + cos w) / 2 of it.
  for (const double degrees : {45.0, 90.0, 120.0}) {
    const double w = degrees * pi_d / 180, size = 1e4;
    const Vec3d up{std::cos(w), 0, std::sin(w)};
    expect_mean(down,
                integrator_xml("ao") + floor_xml() +
                    rectangle_xml(Vec3d{1, 0, 0} + up * size, up * size, {0, size, 0}, ""),
                (1 + std::cos(w)) / 2, "wedge of " + std::to_string(degrees));
  }
}

TEST_P(Unlit, MaterialIsTheBsdfAlongTheNormal) {
  const auto floor = [](const std::string& bsdf) {
    return integrator_xml("material") + rectangle_xml({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, bsdf + light_xml(1));
  };
  const double third = pi_d / 3;
  const View oblique{{2 * std::sin(third), 0, 2 * std::cos(third)}, {0, 0, 0}};
  const double diffuse = 0.5 / pi_d;
  expect_near(color(oblique, floor(diffuse_xml(0.5))), {diffuse, diffuse, diffuse}, 1e-5, "diffuse");
  expect_near(color({{0, 0, -2}, {0, 0, 0}}, floor(diffuse_xml(0.5))), {0, 0, 0}, 0, "from behind");
  expect_near(color({{0, 0, 2}, {0, 0, 5}}, floor(diffuse_xml(0.5))), {0, 0, 0}, 0, "miss");
  // The lobe around the mirror image of either direction: cos(60 deg)^4.
  const double phong = 0.2 / pi_d + 0.3 * 6 / (2 * pi_d) * std::pow(0.5, 4);
  expect_near(color(oblique, floor(phong_xml(0.2, 0.3, 4))), {phong, phong, phong}, 1e-4, "phong");
}

TEST_P(Unlit, SimpleIsAPointLightOverWhite) {
  const std::string light =
      "<point name=\"position\" value=\"1,2,2\"/><color name=\"energy\" value=\"30,20,10\"/>";
  const View view{{0.5, -2, 3}, {0, 0, 0}};
  const double scale = (2.0 / 3) / 9 / (4 * pi_d * pi_d);
  const Vec3d lit{30 * scale, 20 * scale, 10 * scale};
  expect_near(color(view, integrator_xml("simple", light) + floor_xml(1)), lit, 1e-4, "floor");
  const auto blocker = [](const Vec3d& at) { return sphere_xml(at, 0.1, ""); };
  expect_near(color(view, integrator_xml("simple", light) + floor_xml(1) + blocker({0.5, 1, 1})), {0, 0, 0},
              0, "in shadow");
  expect_near(color(view, integrator_xml("simple", light) + floor_xml(1) + blocker({1.5, 3, 3})), lit, 1e-4,
              "behind the light");
  const std::string below =
      "<point name=\"position\" value=\"1,2,-2\"/><color name=\"energy\" value=\"30,20,10\"/>";
  expect_near(color(view, integrator_xml("simple", below) + floor_xml(1)), {0, 0, 0}, 0, "below the horizon");
}

INSTANTIATE_TEST_SUITE_P(Isas, Unlit, testing::ValuesIn(available_isas()),
                         [](const auto& info) { return std::string(isa_name(info.param)); });

TEST(UnlitNames, NeedsWhatItCannotGuess) {
  EXPECT_TRUE(std::get<VisibilityRules>(integrator_from_name("ao").rules).is_cosine_weighted);
  EXPECT_TRUE(std::isinf(std::get<VisibilityRules>(integrator_from_name("av").rules).length));
  EXPECT_THROW(integrator_from_name("simple"), InputError);
}

}  // namespace
}  // namespace etendue

// Which pixels hold an outline of a lamp: all of which dense rays find both it and something else.
//
// Seen to fail when: the filter's radius, the blur of a lens, or the cuts by the clip planes are passed over;
// sides are not clipped; the back of two-sided lamps is; triangles seen from behind keep their order of
// vertices; vertices at one place count as several.
#include "scene/lamp_outlines.h"

#include "integrator/single_sample.h"
#include "test_scene.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace etendue {
namespace {

constexpr int side_px = 20;
constexpr Vec3d eye{0, -5, 0};

LoadedScene scene_of(const std::string& lamp, const std::string& filter = "box", const std::string& more = "",
                     const std::vector<SceneFile>& files = {}) {
  std::string camera = camera_xml(eye, {0, 0, 0}, 40, side_px, "sobol", more);
  camera.replace(camera.find("type=\"box\""), 10, "type=\"" + filter + "\"");
  return load_scene_text(camera + lamp, files);
}

/// Whether a ray meets a side of a lamp that shines.
bool meets_lamp(const Scene& scene, const CameraRay<float>& camera_ray) {
  const Ray<float> ray{camera_ray.origin, camera_ray.direction};
  const Hit<float> hit = closest_hit(scene, ray, camera_ray.t_near, camera_ray.t_far);
  if (hit.geometry < 0) return false;
  const std::int32_t light = scene.geometry.light[std::size_t(hit.geometry)];
  return light >= 0 && (dot(hit.ng, ray.direction) < 0 || scene.lights.is_twosided<float>(light, true));
}

struct Counts {
  int ends = 0, marked = 0, missed = 0;
};

/// Of pixels where rays say that a lamp's image ends, of those that are marked, and of those missed.
Counts counts_of(const Scene& scene, std::mt19937& random, int rays_across = 12) {
  std::uniform_real_distribution<float> unit(0, 1);
  Counts counts;
  const auto reach = float(scene.filter.radius_px());
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      int lit = 0;
      for (int k = 0; k < rays_across * rays_across; ++k) {
        const auto at = [&](int pixel, int cell) {
          return float(pixel) + 0.5f + reach * (2 * (float(cell) + unit(random)) / float(rays_across) - 1);
        };
        const float x_px = at(x, k % rays_across), y_px = at(y, k / rays_across);
        lit += meets_lamp(
            scene, scene.camera.has_lens
                       ? scene.camera.ray(x_px, y_px,
                                          square_to_uniform_disk(Vec2<float>{unit(random), unit(random)}))
                       : scene.camera.ray(x_px, y_px));
      }
      const bool is_marked = scene.lamp_outlines.contains(x, y);
      const bool is_end = lit > 0 && lit < rays_across * rays_across;
      counts.ends += is_end;
      counts.marked += is_marked;
      counts.missed += is_end && !is_marked;
    }
  EXPECT_EQ(scene.lamp_outlines.pixel_count(), counts.marked);
  return counts;
}

/// Lamps of all shapes and sizes, at places before, beside, around and behind the camera.
class RandomLamps {
 public:
  std::mt19937 random{7};
  bool is_around_camera = false;

  std::string light(const char* twosided) const {
    return fmt::format(
        "<luminaire type=\"area\"><color name=\"radiance\" value=\"1\"/><boolean name=\"twosided\" "
        "value=\"{}\"/></luminaire>",
        twosided);
  }
  std::string light() { return light(unit() < 0.5 ? "true" : "false"); }
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random); }
  double within(double most) { return most * (2 * unit() - 1); }
  /// From a hundredth of a pixel to far more than the image.
  double size() { return std::pow(10.0, is_around_camera ? unit() : -3 + 4 * unit()); }
  Vec3d direction() { return normalize(Vec3d{within(1), within(1), within(1)} + Vec3d{0, 0, 1e-3}); }
  Vec3d place(double size) {
    return {within(1.8), within(2) - (is_around_camera ? 5 : 0), within(1.8 + 0.3 * size)};
  }

  std::string rectangle() {
    const double length = size();
    const Vec3d u = direction(), v = cross(u, direction());
    return rectangle_xml(place(length), u * length, v * (length * (0.1 + unit())), light());
  }
  std::string sphere() {
    const double radius = size();
    return sphere_xml(place(radius), radius, light());
  }
  std::string disk() {
    const double radius = size();
    const Vec3d n = direction();
    return fmt::format(
        "<shape type=\"disk\"><transform name=\"toWorld\"><scale value=\"{},{},1\"/><rotate axis=\"{}\" "
        "angle=\"{}\"/><translate value=\"{}\"/></transform>{}</shape>\n",
        radius, radius * (0.2 + unit()), text_of(n), 360 * unit(), text_of(place(radius)), light());
  }
  std::vector<SceneFile> box_file() {
    return {{"lamp.obj", box_obj(place(1), std::min(size(), 3.0), unit() < 0.3)}};
  }
};

using Lamp = std::function<LoadedScene(RandomLamps&, const std::string& filter, const std::string& camera)>;

void expect_none_missed(const Lamp& lamp, const std::string& filter, const std::string& camera, int scenes) {
  RandomLamps lamps;
  Counts sum;
  int plain = 0;
  for (int k = 0; k < scenes; ++k) {
    lamps.is_around_camera = k % 3 == 0;
    const LoadedScene loaded = lamp(lamps, filter, camera);
    const Counts counts = counts_of(loaded.scene, lamps.random);
    EXPECT_EQ(counts.missed, 0) << filter << ", scene " << k;
    sum.ends += counts.ends;
    plain += counts.marked < side_px * side_px;
  }
  EXPECT_GT(sum.ends, 2 * scenes);  // Most lamps are too small for the rays, or seen from behind.
  EXPECT_GT(plain, scenes / 4);
}

void expect_none_missed(const Lamp& lamp) {
  expect_none_missed(lamp, "box", "", 100);
  expect_none_missed(lamp, "gaussian", "", 40);
  expect_none_missed(lamp, "box",
                     "<float name=\"nearClip\" value=\"4.5\"/><float name=\"farClip\" value=\"5.5\"/>", 100);
  expect_none_missed(
      lamp, "box",
      "<float name=\"apertureRadius\" value=\"0.1\"/><float name=\"focusDistance\" value=\"4\"/>", 60);
}

TEST(LampOutlines, HoldWhereRectanglesEnd) {
  expect_none_missed([](RandomLamps& lamps, const std::string& filter, const std::string& camera) {
    return scene_of(lamps.rectangle(), filter, camera);
  });
}

TEST(LampOutlines, HoldWhereSpheresEnd) {
  expect_none_missed([](RandomLamps& lamps, const std::string& filter, const std::string& camera) {
    return scene_of(lamps.sphere(), filter, camera);
  });
}

TEST(LampOutlines, HoldWhereDisksEnd) {
  expect_none_missed([](RandomLamps& lamps, const std::string& filter, const std::string& camera) {
    return scene_of(lamps.disk(), filter, camera);
  });
}

TEST(LampOutlines, HoldWhereMeshesTurnAway) {
  expect_none_missed([](RandomLamps& lamps, const std::string& filter, const std::string& camera) {
    return scene_of(mesh_xml("lamp.obj", lamps.light()), filter, camera, lamps.box_file());
  });
}

/// The square of the film from the third to the seventeenth pixel, cut into n x n squares of two triangles.
std::string square_obj(int n, bool has_vertices_of_its_own) {
  const double half = 7 * 2 * 5 * std::tan(20 * std::numbers::pi / 180) / side_px;
  std::string text;
  int vertices = 0;
  const auto vertex = [&](int i, int j) {
    text += fmt::format("v {} 0 {}\n", half * (2.0 * i / n - 1), half * (2.0 * j / n - 1));
    return ++vertices;
  };
  const auto triangle = [&](int a, int b, int c) { text += fmt::format("f {} {} {}\n", a, b, c); };
  if (!has_vertices_of_its_own)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) vertex(i, j);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = has_vertices_of_its_own ? vertex(i, j) : j * (n + 1) + i + 1,
                b = has_vertices_of_its_own ? vertex(i + 1, j) : a + 1,
                c = has_vertices_of_its_own ? vertex(i + 1, j + 1) : a + n + 2,
                d = has_vertices_of_its_own ? vertex(i, j + 1) : a + n + 1;
      triangle(a, b, c);
      triangle(a, c, d);
    }
  return text;
}

TEST(LampOutlines, LeaveOutWhatIsWithinALamp) {
  for (const bool has_vertices_of_its_own : {false, true}) {
    const std::vector<SceneFile> files{{"lamp.obj", square_obj(9, has_vertices_of_its_own)}};
    const LampOutlines outlines =
        scene_of(mesh_xml("lamp.obj", light_xml(1)), "box", "", files).scene.lamp_outlines;
    for (int y = 0; y < side_px; ++y)
      for (int x = 0; x < side_px; ++x) {
        // The outline runs along the edges of pixels, and belongs to those on both its sides.
        const auto is_on = [](int a) { return a == 2 || a == 3 || a == 16 || a == 17; };
        const auto is_beside = [](int a) { return a >= 2 && a <= 17; };
        EXPECT_EQ(outlines.contains(x, y), (is_on(x) && is_beside(y)) || (is_on(y) && is_beside(x)))
            << x << ", " << y << (has_vertices_of_its_own ? ", apart" : ", shared");
      }
  }
}

TEST(LampOutlines, AreNoneOfWhatDoesNotShine) {
  const Vec3d right{1, 0, 0}, up{0, 0, 1};
  const auto is_empty = [](const LoadedScene& loaded) { return loaded.scene.lamp_outlines.is_empty(); };
  EXPECT_FALSE(is_empty(scene_of(rectangle_xml({0, 0, 0}, right, up, light_xml(1)))));
  EXPECT_TRUE(is_empty(scene_of(rectangle_xml({0, 0, 0}, right, up, diffuse_xml(0.5)))));
  EXPECT_TRUE(is_empty(scene_of(rectangle_xml({0, 0, 0}, up, right, light_xml(1)))));   // from behind
  EXPECT_TRUE(is_empty(scene_of(rectangle_xml({0, -9, 0}, right, up, light_xml(1)))));  // behind the camera
  EXPECT_TRUE(is_empty(scene_of(rectangle_xml({40, 0, 0}, right, up, light_xml(1)))));  // beside the image
  EXPECT_TRUE(is_empty(scene_of(rectangle_xml({0, 0, 0}, right * 9, up * 9, light_xml(1)))));  // fills it
  EXPECT_TRUE(is_empty(scene_of(sphere_xml({0, -5, 0}, 3, light_xml(1)))));                    // from within
  EXPECT_TRUE(is_empty(scene_of(rectangle_xml({0, 0, 0}, right, up, light_xml(1)), "mitchell")));  // signed
}

}  // namespace
}  // namespace etendue

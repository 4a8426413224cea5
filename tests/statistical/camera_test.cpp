// The camera: what a lens keeps sharp and how it blurs the rest, the clip planes, and where on the lens
// samples fall.
//
// False-alarm rate of this file: 1e-5 (Sidak over its chi-squared tests), fixed seeds; the rest is exact up
// to rounding. Seen to fail when: the focus is taken along the ray; the lens is not turned with the camera;
// the radius is halved; the clip planes are distances along the ray; the radius on the disk is u, not its
// root; the lens takes the numbers of the film.
#include "geometry/camera.h"

#include "integrator/camera_stage.h"
#include "stats/chi_squared.h"
#include "stats/significance.h"
#include "test_scene.h"

#include <gtest/gtest.h>
#include <memory>
#include <numbers>
#include <random>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 10;

/// A camera from its parameters in XML, oblique to all axes. \param scale of its toWorld
Camera oblique_camera(const std::string& parameters, double scale = 1) {
  return load_scene_text(
             fmt::format("<camera type=\"perspective\"><integer name=\"width\" value=\"40\"/><integer "
                         "name=\"height\" value=\"30\"/><float name=\"fov\" value=\"70\"/><transform "
                         "name=\"toWorld\"><scale value=\"{}\"/><lookat origin=\"1,2,3\" target=\"3,-1,5\" "
                         "up=\"0.1,0.2,1\"/></transform>{}</camera>\n",
                         scale, parameters) +
             sphere_xml({0, 0, 0}, 1, light_xml(1)))
      .scene.camera;
}
constexpr Vec3f axis_along{2, -3, 2};  // Of the lookat above.

std::string lens_xml(double radius, double focus) {
  return fmt::format(
      "<float name=\"apertureRadius\" value=\"{}\"/><float name=\"focusDistance\" value=\"{}\"/>", radius,
      focus);
}

/// Where the ray meets the plane at `depth` along the optical axis.
Vec3f at_depth(const Camera& camera, const CameraRay<float>& ray, float depth) {
  const Vec3f axis = normalize(axis_along);
  return ray.origin +
         ray.direction * ((depth - dot(ray.origin - narrow(camera.origin), axis)) / dot(ray.direction, axis));
}

struct Place {
  float x_px, y_px;
  Vec2f on_lens;  ///< At its rim.
};
std::vector<Place> places() {
  std::vector<Place> all;
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const float angle = float(random()) * 0x1p-32f * 6.2831853f;
    all.push_back(
        {float(random() % 400) / 10, float(random() % 300) / 10, {std::cos(angle), std::sin(angle)}});
  }
  return all;
}

TEST(Lens, KeepsItsFocalPlaneSharpAndBlursTheRestByTheCircleOfConfusion) {
  constexpr float radius = 0.25f, focus = 5;
  const Camera camera = oblique_camera(lens_xml(radius, focus));
  ASSERT_TRUE(camera.has_lens);
  const Vec3f axis = normalize(axis_along);
  for (const Place& place : places()) {
    const CameraRay<float> middle = camera.ray(place.x_px, place.y_px);
    const CameraRay<float> rim = camera.ray(place.x_px, place.y_px, place.on_lens);
    EXPECT_NEAR(length(rim.direction), 1, 1e-6);
    EXPECT_NEAR(length(rim.origin - narrow(camera.origin)), radius, 1e-6);
    EXPECT_NEAR(dot(rim.origin - narrow(camera.origin), axis), 0, 1e-6) << "the lens is square to the axis";
    EXPECT_LT(length(at_depth(camera, rim, focus) - at_depth(camera, middle, focus)), 1e-5);
    for (const float depth : {1.0f, 4.0f, 7.5f, 20.0f})
      EXPECT_NEAR(length(at_depth(camera, rim, depth) - at_depth(camera, middle, depth)),
                  radius * std::abs(1 - depth / focus), 1e-5 * depth);
  }
}

TEST(Lens, IsScaledWithTheCamera) {
  // Lengths of the camera are its own: toWorld acts on the lens, its focus and the clip planes.
  const Camera camera = oblique_camera(lens_xml(0.25, 5) + "<float name=\"nearClip\" value=\"1e-4\"/>", 2);
  for (const Place& place : places()) {
    const CameraRay<float> middle = camera.ray(place.x_px, place.y_px);
    const CameraRay<float> rim = camera.ray(place.x_px, place.y_px, place.on_lens);
    EXPECT_NEAR(length(rim.origin - narrow(camera.origin)), 0.5, 1e-6);
    EXPECT_LT(length(at_depth(camera, rim, 10) - at_depth(camera, middle, 10)), 2e-5);
    EXPECT_NEAR(middle.t_near * dot(middle.direction, normalize(axis_along)), 2e-4, 1e-9);
  }
}

TEST(Camera, ClipsAlongTheOpticalAxis) {
  const std::string clip = "<float name=\"nearClip\" value=\"0.5\"/><float name=\"farClip\" value=\"40\"/>";
  const Camera camera = oblique_camera(clip + lens_xml(0.25, 5)), pinhole = oblique_camera(clip);
  ASSERT_FALSE(pinhole.has_lens);
  const Vec3f axis = normalize(axis_along);
  for (const Place& place : places())
    for (const CameraRay<float>& ray :
         {pinhole.ray(place.x_px, place.y_px), camera.ray(place.x_px, place.y_px, place.on_lens)}) {
      EXPECT_NEAR(ray.t_near * dot(ray.direction, axis), 0.5, 1e-6);
      EXPECT_NEAR(ray.t_far * dot(ray.direction, axis), 40, 1e-4);
    }
}

TEST(Camera, APinholeIsALensOfRadiusZero) {
  const Camera pinhole = oblique_camera(""), closed = oblique_camera(lens_xml(0, 5));
  EXPECT_FALSE(closed.has_lens);
  for (const Place& place : places())
    EXPECT_EQ(pinhole.ray(place.x_px, place.y_px).direction, closed.ray(place.x_px, place.y_px).direction);
}

/// Counts by (squared radius, angle): all cells are alike under a uniform density.
class DiskCells {
 public:
  void add(double x, double y) {
    ASSERT_LE(std::hypot(x, y), 1 + 1e-6);
    const double turns = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
    ++counts_[std::size_t(std::min(int((x * x + y * y) * rings), rings - 1) * sectors +
                          std::min(int(turns * sectors), sectors - 1))];
  }
  void expect_uniform(double total, const char* what) const {
    const ChiSquaredTest test =
        chi_squared_test(counts_, std::vector<double>(counts_.size(), total / double(counts_.size())));
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << what << ": chi-squared " << test.statistic;
  }

 private:
  static constexpr int rings = 16, sectors = 32;
  std::vector<double> counts_ = std::vector<double>(rings * sectors);
};

TEST(Lens, DiskIsUniform) {
  std::mt19937 random(2);
  constexpr int n = 1 << 20;
  DiskCells cells;
  for (int i = 0; i < n; ++i) {
    const float u_x = float(random() >> 8) * 0x1p-24f, u_y = float(random() >> 8) * 0x1p-24f;
    const Vec2f p = square_to_uniform_disk(Vec2f{u_x, u_y});
    cells.add(p.x, p.y);
  }
  cells.expect_uniform(n, "square_to_uniform_disk");
  EXPECT_EQ(square_to_uniform_disk(Vec2f{0.5f, 0.5f}), (Vec2f{0, 0}));
}

TEST(Lens, RaysStartUniformlyOnItWhereverTheFilterPutThem) {
  const LoadedScene loaded =
      load_scene_text("<sampler type=\"sobol\"/><camera type=\"perspective\">" + lens_xml(2, 10) +
                      "<rfilter type=\"box\"/></camera>\n" + sphere_xml({0, 0, 5}, 1, light_xml(1)));
  const auto block = std::make_unique<SampleBlock>();
  DiskCells cells;
  std::vector<double> joint(16 * 16);
  constexpr int blocks = 256;
  for (int b = 0; b < blocks; ++b) {
    block->count = block->padded_count = block_capacity;
    for (int i = 0; i < block_capacity; ++i) {
      const std::uint64_t stream = sample_stream(7, b, 0, i / 16);
      block->pixel_x[i] = b;
      block->pixel_y[i] = 0;
      block->path.stream_lo[i] = std::uint32_t(stream);
      block->path.stream_hi[i] = std::uint32_t(stream >> 32);
      block->path.index[i] = std::uint32_t(i % 16);
    }
    camera_rays<float>(loaded.scene, *block);
    for (int i = 0; i < block_capacity; ++i) {
      const double x = block->path.ray.origin.x[i] / 2, y = block->path.ray.origin.y[i] / 2;
      cells.add(x, y);
      const double u_film =
          to_unit_float(sample_bits<float>(loaded.scene, block->path, i, dimension::film).x);
      const double turns = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
      ++joint[std::size_t(std::min(int(turns * 16), 15) * 16 + int(u_film * 16))];
    }
  }
  constexpr double total = double(blocks) * block_capacity;
  cells.expect_uniform(total, "origins of rays");
  const ChiSquaredTest test = chi_squared_test(joint, std::vector<double>(joint.size(), total / 256));
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << "lens and film: chi-squared " << test.statistic;
}

}  // namespace
}  // namespace etendue

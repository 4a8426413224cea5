// Every kind of light: points follow pdf_area, which integrates to 1; the choice of a light follows its pmf.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the alias table's thresholds are all 2^31; what is left of u.y is not stretched back;
// square_to_triangle does not fold; sin_max_sq has the radius unsquared; pdf_area of the sphere lacks the
// cosine; the sine at its centre comes from the cosine (near receivers); the rectangle's pdf is 2 / area;
// the disk's pdf is 1 / area of its box; the disk's radius is u;
// some lights are chosen more often.
#include "light/light.h"

#include "geometry/shapes.h"
#include "integrator/light_sampling.h"
#include "sphere_cells.h"
#include "stats/chi_squared.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <string>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 150;
constexpr int samples = 200000;

Vec3d wide(const Vec3f& v) { return {v.x, v.y, v.z}; }

class RandomBits {
 public:
  explicit RandomBits(unsigned seed) : engine_(seed) {}
  Vec2<std::uint32_t> square() {
    const std::uint32_t x = engine_();
    return {x, std::uint32_t(engine_())};
  }

 private:
  std::mt19937 engine_;
};

void expect_counts(const std::vector<double>& observed, const std::vector<double>& expected,
                   const std::string& what, double most_in_empty_cell = 0) {
  const ChiSquaredTest test =
      chi_squared_test(observed, expected, {.most_in_empty_cell = most_in_empty_cell});
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << what << ": chi-squared " << test.statistic << ", " << test.degrees_of_freedom
      << " degrees of freedom, cell " << test.wrong_empty_cell << " should be empty";
}

/// A light alone, and the geometry it lies on.
struct Alone {
  Geometry geometry;
  Lights lights;

  LightPoint<float> sample(const Vec3f& reference, const Vec2<std::uint32_t>& u) const {
    const LightPoint<float> point = lights.sample_position<float>(geometry, 0, reference, u, true);
    // Both sides of every MIS weight see one density.
    EXPECT_NEAR(point.pdf_area, (lights.pdf_area<float>(0, reference, point.position, point.ng, true)),
                1e-5f * point.pdf_area);
    EXPECT_NEAR(length(wide(point.ng)), 1, 1e-5);
    EXPECT_TRUE(point.piece >= 0 && point.piece < light_pieces) << point.piece;
    return point;
  }
};

/// Not inline: GCC 12 else sees a vector that it knows to be empty, and warns of what cannot happen.
[[gnu::noinline]] void add_sphere_light(Alone& alone, const Sphere& sphere) {
  alone.lights.add({1, 1, 1}, "sphere", LightKind::sphere, alone.lights.spheres.add(sphere));
}

TEST(MeshLight, TrianglesOfVeryUnequalAreaAreChosenByAreaAndFilledEvenly) {
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> uniform;
  for (const int triangles : {1, 2, 1000}) {
    // Triangle k lies at z = k, so that a point tells its triangle.
    Mesh mesh;
    std::vector<double> areas;
    double total = 0;
    for (int k = 0; k < triangles; ++k) {
      const double a = std::pow(10, -4 * uniform(engine)), b = 1 + uniform(engine);
      for (const Vec3f& p :
           {Vec3f{0, 0, float(k)}, Vec3f{float(a), 0, float(k)}, Vec3f{float(0.5 * a), float(b), float(k)}})
        mesh.positions.push_back(p);
      for (std::uint32_t corner = 0; corner < 3; ++corner)
        mesh.indices.push_back(std::uint32_t(3 * k) + corner);
      areas.push_back(0.5 * mesh.positions[std::size_t(3 * k + 1)].x * double(float(b)));
      total += areas.back();
    }
    Alone alone;
    const std::int32_t id = alone.geometry.add_mesh(mesh, {0, 0});
    alone.lights.add({1, 1, 1}, "mesh", LightKind::mesh, alone.lights.meshes.add(alone.geometry, id));

    // Per triangle, four cells of equal area.
    std::vector<double> observed(std::size_t(4 * triangles)), expected;
    RandomBits random(5);
    for (int i = 0; i < samples; ++i) {
      const LightPoint<float> point = alone.sample({0.3f, 0.2f, -5}, random.square());
      ASSERT_NEAR(point.pdf_area * total, 1, 1e-5);
      const auto k = std::size_t(std::lround(point.position.z));
      const double y = point.position.y / mesh.positions[3 * k + 2].y,
                   x = point.position.x / mesh.positions[3 * k + 1].x - 0.5 * y;
      ASSERT_TRUE(x > -1e-4 && y > -1e-4 && x + y < 1 + 1e-4);
      ++observed[4 * k + (x > 0.5 ? 1 : y > 0.5 ? 2 : x + y < 0.5 ? 3 : 0)];
    }
    for (const double area : areas)
      for (int cell = 0; cell < 4; ++cell) expected.push_back(0.25 * samples * area / total);
    expect_counts(observed, expected, std::to_string(triangles) + " triangles");
  }
}

TEST(RectangleLight, PointsAreUniformOverIt) {
  for (const float size : {1e-4f, 1.0f, 1e4f}) {
    Alone alone;
    const Vec3f corner{1, -2, 3}, edge_u{size, 0, 0}, edge_v{0.5f * size, 0.7f * size, 0};
    alone.lights.add({1, 1, 1}, "rectangle", LightKind::rectangle,
                     alone.lights.rectangles.add(corner, edge_u, edge_v));
    std::vector<double> observed(256);
    RandomBits random(6);
    for (int i = 0; i < samples; ++i) {
      const LightPoint<float> point = alone.sample({0, 0, 4}, random.square());
      ASSERT_NEAR(point.pdf_area * (0.7 * size * size), 1, 1e-5);
      ASSERT_NEAR(point.ng.z, 1, 1e-6);
      const double y = (double(point.position.y) - corner.y) / edge_v.y,
                   x = (double(point.position.x) - corner.x - edge_v.x * y) / size;
      // A tiny light far from the origin has few float positions: its cells would not be equal.
      if (size >= 1)
        ++observed[std::size_t(std::clamp(int(x * 16), 0, 15) * 16 + std::clamp(int(y * 16), 0, 15))];
    }
    if (size >= 1)
      expect_counts(observed, std::vector<double>(256, samples / 256.0), "rectangle " + std::to_string(size));
  }
}

TEST(DiskLight, PointsAreUniformOverIt) {
  // A circle, an ellipse, a sheared one, and a mirror image of it.
  const Transform transforms[] = {
      scaling({2, 2, 2}), translation({1, 2, 3}) * rotation({1, 1, 0}, 40) * scaling({3, 0.5, 1}),
      Transform{{{{1, 0.7, 0, 4}, {0, 1, 0, 0}, {0.5, 0, 1, -1}, {0, 0, 0, 1}}}},
      Transform{{{{-1, 0.7, 0, 4}, {0, 1, 0, 0}, {0.5, 0, 1, -1}, {0, 0, 0, 1}}}}};
  for (const Transform& transform : transforms) {
    Alone alone;
    const Disk disk = make_disk(transform);
    alone.lights.add({1, 1, 1}, "disk", LightKind::disk, alone.lights.disks.add(disk));
    const Vec3d along_x = wide(disk.along_x), along_y = wide(disk.along_y), across = cross(along_x, along_y);
    const Vec3d front = normalize(transform_normal(transform, {0, 0, 1}));
    // Rings of equal area, each in sectors of equal angle, on the unit disk.
    std::vector<double> observed(8 * 24);
    RandomBits random(11);
    for (int i = 0; i < samples; ++i) {
      const LightPoint<float> point = alone.sample({0, 0, 40}, random.square());
      ASSERT_NEAR(point.pdf_area * std::numbers::pi * length(across), 1, 1e-5);
      ASSERT_NEAR(dot(wide(point.ng), front), 1, 1e-5);
      const Vec3d p = wide(point.position) - wide(disk.center);
      ASSERT_NEAR(dot(p, front), 0, 1e-5);
      const double x = dot(cross(p, along_y), across) / length_sq(across),
                   y = dot(cross(along_x, p), across) / length_sq(across);
      ASSERT_LT(x * x + y * y, 1 + 1e-5);
      const int ring = std::min(int(8 * (x * x + y * y)), 7),
                sector = std::min(int(24 * (0.5 + std::atan2(y, x) / (2 * std::numbers::pi))), 23);
      ++observed[std::size_t(24 * ring + sector)];
    }
    expect_counts(observed, std::vector<double>(observed.size(), samples / 192.0), "disk");
  }
}

TEST(SphereLight, PointsFollowTheDensityFromNearAndFar) {
  for (const double distance : {1.001, 1.1, 2.0, 30.0, 1000.0})
    for (const float radius : {0.01f, 1.0f, 100.0f}) {
      Alone alone;
      const Vec3d center{0.25, -0.5, 2}, axis = normalize(Vec3d{1, 2, -0.5});
      const Sphere sphere{{float(center.x), float(center.y), float(center.z)}, radius};
      add_sphere_light(alone, sphere);
      const Vec3d from = wide(sphere.center) + axis * (distance * radius);
      const Vec3f reference{float(from.x), float(from.y), float(from.z)};
      const WideFrame frame(normalize(wide(reference) - wide(sphere.center)));
      // Cells within the visible cap, cos from 1 / distance to 1, stretched over the whole sphere;
      // the fourth power makes them small around the point right below a near receiver.
      const double cap = 1 - radius / length(wide(reference) - wide(sphere.center));
      const auto cells = even_cells();
      const auto on_sphere = [&](const Vec3d& stretched) {
        const double one_minus_cos = std::pow(0.5 * (1 - stretched.z), 4) * cap,
                     sine = std::sqrt(one_minus_cos * (2 - one_minus_cos));
        const double flat = std::hypot(stretched.x, stretched.y);
        return frame.world_from_local(
            {sine * stretched.x / flat, sine * stretched.y / flat, 1 - one_minus_cos});
      };
      std::vector<double> expected = cells.integrals(
          [&](const Vec3d& stretched) {
            const Vec3d ng = on_sphere(stretched), position = wide(sphere.center) + ng * double(radius);
            const auto narrow = [](const Vec3d& v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
            return 2 * cap * std::pow(0.5 * (1 - stretched.z), 3) * radius * radius *
                   alone.lights.pdf_area<float>(0, reference, narrow(position), narrow(ng), true);
          },
          8);
      double total = 0;
      for (double& e : expected) {
        total += e;
        e *= samples;
      }
      const std::string what =
          "radius " + std::to_string(radius) + ", distance " + std::to_string(distance) + " radii";
      // A receiver just above the sphere knows its height to a few digits only.
      EXPECT_NEAR(total, 1, distance < 1.01 ? 5e-2 : 2e-3) << what;
      std::vector<double> observed(cells.size());
      RandomBits random(7);
      for (int i = 0; i < samples; ++i) {
        const LightPoint<float> point = alone.sample(reference, random.square());
        const Vec3d ng = frame.local_from_world(normalize(wide(point.ng)));
        const double sin_sq = ng.x * ng.x + ng.y * ng.y,
                     one_minus_cos = ng.z > 0 ? sin_sq / (1 + ng.z) : 1 - ng.z;
        const double z = 1 - 2 * std::pow(one_minus_cos / cap, 0.25),
                     scale = std::sqrt(std::max(0.0, 1 - z * z) / std::max(sin_sq, 1e-30));
        ++observed[cells.cell_of({ng.x * scale, ng.y * scale, std::clamp(z, -1.0, 1.0)})];
      }
      if (distance > 1.01 || radius >= 1) expect_counts(observed, expected, what, 5);
    }
}

TEST(SphereLight, GivesNoSampleInside) {
  Alone alone;
  add_sphere_light(alone, {{0, 0, 0}, 1});
  RandomBits random(8);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ((alone.lights.sample_position<float>(alone.geometry, 0, {0.2f, 0.1f, 0}, random.square(), true)
                   .pdf_area),
              0);
}

TEST(LightSampler, ChoosesEachLightWithItsProbability) {
  RandomBits random(9);
  for (const std::int32_t lights : {1, 3, 16, 1000}) {
    std::vector<double> observed(static_cast<std::size_t>(lights));
    double left = 0;
    for (int i = 0; i < samples; ++i) {
      const LightChoice<float> choice = choose_light_uniformly<float>(lights, random.square().x);
      ASSERT_EQ(choice.pmf, uniform_light_pmf(lights));
      ++observed[std::size_t(choice.light)];
      left += choice.u_left * 0x1p-32;
    }
    EXPECT_NEAR(left / samples, 0.5, 5 * std::sqrt(1.0 / 12 / samples))
        << "what is left over must be uniform";
    if (lights > 1)
      expect_counts(observed,
                    std::vector<double>(observed.size(), samples * double(uniform_light_pmf(lights))),
                    std::to_string(lights) + " lights");
  }
}

/// Solid angle and projected solid angle come out right, and the density is the one that MIS sees.
TEST(LightSample, IntegratesTheSolidAngleAndStatesTheDensityOfItsDirection) {
  const Vec3d center{0, 0, 2}, half_u{0.9, 0, 0.3}, half_v{0, -0.6, 0.1}, sphere_center{1, 2, 1};
  const LoadedScene loaded = load_scene_text(
      camera_xml({0, 0, 0}, {0, 0, 1}, 30, 4, "independent") +
          rectangle_xml(center, half_u, half_v, light_xml(2)) + sphere_xml(sphere_center, 0.7, light_xml(3)) +
          mesh_xml("light.obj", light_xml(5)),
      {{"light.obj", polygon_obj({{-2, 0, 1}, {-2, 1, 1.5}, {-2, 0.5, 2.5}, {-2, -0.5, 2}})}});
  const Scene& scene = loaded.scene;
  const auto corners = rectangle_corners(center, half_u, half_v);
  const Vec3d up{0, 0, 1};
  const double exact =
      polygon_irradiance(corners, 2, {0, 0, 0}, up) +
      sphere_irradiance(sphere_center, 0.7, 3, {0, 0, 0}, up) +
      polygon_irradiance({{-2, 0, 1}, {-2, 1, 1.5}, {-2, 0.5, 2.5}, {-2, -0.5, 2}}, 5, {0, 0, 0}, up);
  RandomBits random(10);
  RunningStatistics irradiance;
  for (int i = 0; i < samples; ++i) {
    const LightSample<float> sample = sample_lights<float>(scene, {0, 0, 0}, random.square(), true);
    irradiance.add(sample.is_there ? double(sample.radiance_over_pdf.g) * std::max(0.0f, sample.wi.z) : 0);
    if (!sample.is_there) continue;
    const std::int32_t light = sample.light;
    const Vec3f ng = light == 1   ? Vec3f(normalize(sample.end - Vec3f{1, 2, 1}))
                     : light == 0 ? Vec3f{float(normalize(cross(half_u, half_v)).x),
                                          float(normalize(cross(half_u, half_v)).y),
                                          float(normalize(cross(half_u, half_v)).z)}
                                  : Vec3f{1, 0, 0};
    const float pdf = light_pdf_solid_angle<float>(scene, light, {0, 0, 0}, sample.end, ng, sample.wi, true);
    ASSERT_NEAR(sample.pdf_solid_angle() / pdf, 1, 2e-4) << "light " << light;
  }
  const MeanTest test = t_test(irradiance, exact);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << irradiance.mean << ", exact " << exact;
}

}  // namespace
}  // namespace etendue

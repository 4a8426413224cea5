// Every kind of light: samples follow their density, which integrates to 1; powers and bounds hold all of it.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the alias table's thresholds are all 2^31; what is left of u.y is not stretched back;
// square_to_triangle does not fold; sin_max_sq has the radius unsquared; pdf_area of the sphere lacks the
// cosine; the sine at its centre comes from the cosine (near receivers); the rectangle's pdf is 2 / area;
// some lights are chosen more often; a disk is not uniform, half as bright or wide, or its density 1 % off,
// or that of its box, or its radius is u; a point's power is over 2 pi, its distance left out; a spot's power
// is by the mean of its edges' cosines, or it shines backwards; a direction is reversed or not turned; of a
// map, the seam is left out, phi runs the other way, the rotation is transposed, sin(theta) is left out of
// weights or density, the caps are even in theta, places in a cell are uniform, the search for a cell is
// off, or the share beside a sun is missing; the choice's pmf is missing; a segment ends within the scene;
// the density of a light from everywhere lacks the cosine, or goes by the front where the back is lit.
#include "light/light.h"

#include "geometry/bounds.h"
#include "geometry/shapes.h"
#include "image/image_file.h"
#include "sphere_cells.h"
#include "stats/chi_squared.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
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

Receiver<float> receiver_at(const Vec3f& position) {
  return {position, {0, 0, 1}, {0, 0, 1}, lit_side::front | lit_side::back};
}

/// A light alone, and the geometry it lies on.
struct Alone {
  Geometry geometry;
  Lights lights;

  /// A point on the light, by the table of its kind. Its density is in the sample that the point gives, and
  /// is the one that a hit there has: both sides of every MIS weight see one density.
  template <class Table>
  LightPoint<float> point(const Vec3f& from, const Vec2<std::uint32_t>& u) const {
    const Receiver<float> receiver = receiver_at(from);
    LightPoint<float> point;
    if constexpr (std::is_same_v<Table, SphereLights>)
      point = lights.table<SphereLights>().sample_position<float>(0, from, u);
    else
      point = lights.table<Table>().template sample_position<float>(0, u);
    EXPECT_NEAR(length(wide(point.ng)), 1, 1e-5);
    EXPECT_TRUE(point.piece >= 0 && point.piece < light_pieces) << point.piece;
    const LightSample<float> sample = lights.sample<float>(0, 1, receiver, u, true);
    // The shadow segment ends above the point, as far as rounding may misplace it, and no farther.
    const Vec3d above = wide(sample.end) - wide(point.position);
    const double size = length(wide(point.position)) + length(wide(from)) + 10;
    EXPECT_GE(dot(above, wide(point.ng)), 0);
    EXPECT_LE(length(above), 2e-6 * size);
    const float found =
        lights.pdf_solid_angle<float>(0, 1, receiver, {point.position, point.ng, sample.wi, 0}, true);
    EXPECT_NEAR(sample.pdf_solid_angle, found, 1e-5f * found);
    if (sample.is_there) {
      const double distance_sq = length_sq(wide(point.position) - wide(from)),
                   cosine = -dot(wide(point.ng), wide(sample.wi));
      // Near the light's plane the cosine is a difference of nearly equal numbers.
      if (cosine > 1e-2) {
        EXPECT_NEAR(sample.pdf_solid_angle, point.pdf_area * distance_sq / cosine,
                    1e-3 * sample.pdf_solid_angle);
      }
    }
    return point;
  }
};

/// Not inline: GCC 12 else sees a vector that it knows to be empty, and warns of what cannot happen.
[[gnu::noinline]] void add_sphere_light(Alone& alone, const Sphere& sphere) {
  alone.lights.add<SphereLights>({1, 1, 1}, "sphere", sphere);
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
    alone.lights.add<MeshLights>({1, 1, 1}, "mesh", alone.geometry, id);

    // Per triangle, four cells of equal area.
    std::vector<double> observed(std::size_t(4 * triangles)), expected;
    RandomBits random(5);
    for (int i = 0; i < samples; ++i) {
      const LightPoint<float> point = alone.point<MeshLights>({0.3f, 0.2f, -5}, random.square());
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
    alone.lights.add<RectangleLights>({1, 1, 1}, "rectangle", corner, edge_u, edge_v);
    std::vector<double> observed(256);
    RandomBits random(6);
    for (int i = 0; i < samples; ++i) {
      const LightPoint<float> point = alone.point<RectangleLights>({0, 0, 4}, random.square());
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
    alone.lights.add<DiskLights>({1, 1, 1}, "disk", disk);
    const Vec3d along_x = wide(disk.along_x), along_y = wide(disk.along_y), across = cross(along_x, along_y);
    const Vec3d front = normalize(transform_normal(transform, {0, 0, 1}));
    // Rings of equal area, each in sectors of equal angle, on the unit disk.
    std::vector<double> observed(8 * 24);
    RandomBits random(11);
    for (int i = 0; i < samples; ++i) {
      const LightPoint<float> point = alone.point<DiskLights>({0, 0, 40}, random.square());
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
                   alone.lights.table<SphereLights>().pdf_area<float>(0, reference, narrow(position),
                                                                      narrow(ng));
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
        const LightPoint<float> point = alone.point<SphereLights>(reference, random.square());
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
    EXPECT_FALSE(
        (alone.lights.sample<float>(0, 1, receiver_at({0.2f, 0.1f, 0}), random.square(), true).is_there));
}

/// The light alone among many, as an environment: its directions against its density.
LightSample<float> sample_of(const Alone& alone, const Vec2<std::uint32_t>& u,
                             const Receiver<float>& receiver = receiver_at({0.5f, -1, 2}),
                             LightTechnique technique = LightTechnique::area) {
  return alone.lights.sample<float>(0, 1, receiver, u, true, whole_light, technique);
}

void expect_directions_follow_density(const Alone& alone, const std::string& what, int steps,
                                      double tolerance_of_total, int sample_count = samples,
                                      const Receiver<float>& receiver = receiver_at({0.5f, -1, 2}),
                                      LightTechnique technique = LightTechnique::area) {
  const auto cells = even_cells();
  const auto pdf = [&](const Vec3d& d) {
    return double(alone.lights.infinite_pdf_solid_angle<float>(
        0, receiver, {float(d.x), float(d.y), float(d.z)}, true, technique));
  };
  std::vector<double> expected = cells.integrals(pdf, steps);
  double total = 0;
  for (double& e : expected) {
    total += e;
    e *= sample_count;
  }
  EXPECT_NEAR(total, 1, tolerance_of_total) << what;
  std::vector<double> observed(cells.size());
  RandomBits random(11);
  int odd_densities = 0, odd_radiances = 0;
  for (int i = 0; i < sample_count; ++i) {
    const LightSample<float> sample = sample_of(alone, random.square(), receiver, technique);
    ASSERT_TRUE(sample.is_there) << what;
    ASSERT_NEAR(length(wide(sample.wi)), 1, 1e-5) << what;
    ASSERT_TRUE(sample.piece >= 0 && sample.piece < light_pieces) << sample.piece;
    ++observed[cells.cell_of(wide(sample.wi))];
    // Both sides of every MIS weight see one density; rounding may move a direction over the rim of a disk.
    const double stated = sample.pdf_solid_angle, found = pdf(wide(sample.wi));
    odd_densities += !(std::abs(stated - found) < 2e-3 * stated);
    const Colorf radiance = alone.lights.infinite_radiance<float>(0, sample.wi, true);
    odd_radiances += !(std::abs(sample.radiance_over_pdf.g * stated - radiance.g) < 2e-3 * radiance.g + 1e-6);
  }
  EXPECT_LT(odd_densities, 1e-3 * sample_count) << what;
  EXPECT_LT(odd_radiances, 1e-3 * sample_count) << what;
  expect_counts(observed, expected, what);
}

[[gnu::noinline]] void add_disk(Alone& alone, const DistantDisk& disk) {
  alone.lights.add<DistantDiskLights>(disk.radiance, "disk", disk);
}

TEST(DistantDisk, DirectionsFollowTheDensity) {
  const Vec3d axis = normalize(Vec3d{1, -2, -2});
  for (const double half_angle_deg : {40.0, 90.0, 150.0, 180.0}) {
    Alone alone;
    add_disk(alone, {{float(axis.x), float(axis.y), float(axis.z)},
                     float(half_angle_deg / 180 * std::numbers::pi),
                     {1, 2, 3}});
    // The rim cuts through cells: many steps.
    expect_directions_follow_density(alone, "disk of " + std::to_string(half_angle_deg) + " degrees", 60,
                                     1e-3);
  }
}

TEST(DistantDisk, OfAllDirectionsFollowsTheCosineWhereOneSideIsLit) {
  Alone alone;
  add_disk(alone, {{0, 0, 1}, std::numbers::pi_v<float>, {1, 2, 3}});
  Receiver<float> receiver = receiver_at({0.5f, -1, 2});
  receiver.ng = receiver.ns = normalize(Vec3f{1, -2, 2});
  constexpr LightTechnique best = LightTechnique::automatic;
  for (const std::int32_t side : {lit_side::front, lit_side::back}) {
    receiver.lit_sides = side;
    const LightSample<float> sample = sample_of(alone, {1u << 30, 3u << 29}, receiver, best);
    const float cosine = dot(receiver.ns, sample.wi) * (side == lit_side::front ? 1.0f : -1.0f);
    EXPECT_NEAR(sample.pdf_solid_angle * std::numbers::pi, cosine, 1e-6);
    expect_directions_follow_density(alone, "side " + std::to_string(side), 60, 1e-3, samples, receiver,
                                     best);
  }
  receiver.lit_sides = lit_side::front | lit_side::back;
  expect_directions_follow_density(alone, "both sides", 20, 1e-3, samples, receiver, best);
  EXPECT_NEAR(sample_of(alone, {1, 2}, receiver, best).pdf_solid_angle * 4 * std::numbers::pi, 1, 1e-6);
}

TEST(DistantDisk, TheSunIsRoundAndOfItsSize) {
  Alone alone;
  const double half_angle = 0.27 / 180 * std::numbers::pi;
  add_disk(alone, {{0, 0.6f, 0.8f}, float(half_angle), {1, 1, 1}});
  const double solid_angle = 4 * std::numbers::pi * std::pow(std::sin(half_angle / 2), 2);
  const WideFrame frame(normalize(Vec3d{0, double(0.6f), double(0.8f)}));
  std::vector<double> observed(64);
  RandomBits random(12);
  for (int i = 0; i < samples; ++i) {
    const LightSample<float> sample = sample_of(alone, random.square());
    ASSERT_NEAR(sample.pdf_solid_angle * solid_angle, 1, 1e-5);
    const Vec3d d = frame.local_from_world(wide(sample.wi));
    const double ring = (d.x * d.x + d.y * d.y) / std::pow(std::sin(half_angle), 2),
                 turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5;
    ++observed[std::size_t(std::clamp(int(ring * 8), 0, 7) * 8 + std::clamp(int(turn * 8), 0, 7))];
  }
  expect_counts(observed, std::vector<double>(64, samples / 64.0), "sun");
}

/// Random texels, one row of zeros, and one texel that has half of all light.
std::vector<float> random_map(int width, int height, bool has_hot_texel) {
  std::mt19937 engine(13);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> rgb;
  for (int i = 0; i < 3 * width * height; ++i) rgb.push_back(uniform(engine));
  if (height > 2)
    for (int i = 0; i < 3 * width; ++i) rgb[std::size_t(3 * width * (height / 2) + i)] = 0;
  if (has_hot_texel)
    for (std::size_t k = 0; k < 3; ++k)
      rgb[k + 3 * std::size_t(width * (height / 3) + 1)] = float(width * height) / 2;
  return rgb;
}

[[gnu::noinline]] void add_envmap(Alone& alone, int width, int height, const std::vector<float>& rgb,
                                  const Transform& world_from_map = {}) {
  alone.lights.add<EnvmapLights>({1, 1, 1}, "map", Envmap(width, height, rgb), world_from_map);
}

TEST(Envmap, DirectionsFollowTheDensity) {
  struct Size {
    int width, height;
    bool has_hot_texel, is_compensated = false;
  };
  for (const auto& [width, height, has_hot_texel, is_compensated] :
       {Size{1, 1, false}, Size{2, 1, false}, Size{1, 3, false}, Size{8, 4, false}, Size{16, 9, false},
        Size{16, 9, true}, Size{64, 32, true}, Size{16, 9, false, true}, Size{16, 9, true, true}}) {
    Alone alone;
    // Upright in the cells, and then askew.
    add_envmap(alone, width, height, random_map(width, height, has_hot_texel),
               width == 8 ? rotation({1, 2, 3}, 77) * scaling({-1, 1, 1}) : rotation({1, 0, 0}, 90));
    if (is_compensated) alone.lights.compensate_environments();
    expect_directions_follow_density(alone,
                                     "map of " + std::to_string(width) + " x " + std::to_string(height) +
                                         (has_hot_texel ? ", hot" : "") +
                                         (is_compensated ? ", compensated" : ""),
                                     60, 1e-3);
  }
}

/// A sun below the horizon has all but 1e-7 of the light, and what lies in the sky must be found all the
/// same.
TEST(Envmap, WhatIsBesideASunKeepsAShareOfTheSamples) {
  constexpr int width = 32, height = 16;
  Alone alone;
  std::vector<float> rgb(3 * width * height);
  std::fill_n(rgb.begin(), rgb.size() / 2, 1.0f);
  for (std::size_t k = 0; k < 3; ++k) rgb[k + 3 * (width * 12 + 5)] = 1e10f;
  add_envmap(alone, width, height, rgb, rotation({1, 0, 0}, 90));
  expect_directions_follow_density(alone, "map with a sun", 60, 1e-3);
  RunningStatistics irradiance, is_in_sky;
  RandomBits random(18);
  for (int i = 0; i < samples; ++i) {
    const LightSample<float> sample = sample_of(alone, random.square());
    const bool is_high = sample.wi.z > 0.5f;
    irradiance.add(is_high ? double(sample.radiance_over_pdf.g * sample.wi.z) : 0);
    is_in_sky.add(is_high);
  }
  const MeanTest test = t_test(irradiance, 0.75 * std::numbers::pi);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << irradiance.mean << ", p = " << test.p_value;
  EXPECT_NEAR(is_in_sky.mean, 0.05 * 0.5, 0.005);  // Half of the sky, which has 1 of 20 samples.
}

TEST(Envmap, NoDirectionOfABlackTexelIsSampled) {
  Alone alone;
  std::vector<float> rgb(3 * 8 * 6);
  for (std::size_t k = 0; k < 3; ++k) rgb[3 * (8 * 2 + 5) + k] = 1;
  add_envmap(alone, 8, 6, rgb);
  RandomBits random(14);
  for (int i = 0; i < 10000; ++i) {
    const LightSample<float> sample = sample_of(alone, random.square());
    ASSERT_TRUE(sample.is_there);
    const double u = std::atan2(sample.wi.x, -sample.wi.z) / (2 * std::numbers::pi),
                 v = std::acos(sample.wi.y) / std::numbers::pi;
    ASSERT_NEAR(u < 0 ? u + 1 : u, 5.5 / 8, 1.0 / 8 + 1e-5);
    ASSERT_NEAR(v, 2.5 / 6, 1.0 / 6 + 1e-5);
  }
}

/// One texel at a time: its colour must come from where the orientation of Mitsuba 0.x puts it.
TEST(Envmap, TexelsStandWhereTheConventionSays) {
  constexpr int width = 12, height = 6;
  Alone alone;
  std::vector<float> rgb;
  for (int i = 0; i < 3 * width * height; ++i) rgb.push_back(float(i + 1));
  const Transform turn = rotation({1, 0, 0}, 90);  // As in the family's table scene: y up becomes z up.
  add_envmap(alone, width, height, rgb, turn);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double phi = 2 * std::numbers::pi * (i + 0.5) / width,
                   theta = std::numbers::pi * (j + 0.5) / height;
      const Vec3d d = transform_vector(
          turn, {std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)});
      const Colorf radiance =
          alone.lights.infinite_radiance<float>(0, {float(d.x), float(d.y), float(d.z)}, true);
      const auto at = std::size_t(3 * (j * width + i));
      EXPECT_NEAR(radiance.r, rgb[at], 1e-3) << i << ", " << j;
      EXPECT_NEAR(radiance.b, rgb[at + 2], 1e-3) << i << ", " << j;
    }
  EXPECT_NEAR((alone.lights.infinite_radiance<float>(0, {0, 0, 1}, true).g), rgb[1 + 3 * (width - 1)], 17)
      << "the zenith is z, and has the first row";
  // Over the seam, half way from the last texel of the middle row to the first.
  constexpr int middle = 3 * width * (height / 2);
  const double theta = std::numbers::pi * (height / 2 + 0.5) / height;
  const Vec3d seam = transform_vector(turn, {0, std::cos(theta), -std::sin(theta)});
  EXPECT_NEAR(
      (alone.lights.infinite_radiance<float>(0, {float(seam.x), float(seam.y), float(seam.z)}, true).r),
      0.5 * (rgb[std::size_t(middle)] + rgb[std::size_t(middle + 3 * (width - 1))]), 1e-3);
}

TEST(Envmap, HasAValueAtThePolesAndNoneForNoDirection) {
  Alone alone;
  add_envmap(alone, 8, 6, random_map(8, 6, false));
  for (const float y : {1.0f, -1.0f})
    for (const float zero : {0.0f, -0.0f}) {
      EXPECT_GT((alone.lights.infinite_radiance<float>(0, {zero, y, zero}, true).g), 0);
      const float pdf =
          alone.lights.infinite_pdf_solid_angle<float>(0, receiver_at({0, 0, 0}), {zero, y, zero}, true);
      EXPECT_TRUE(pdf > 0 && std::isfinite(pdf)) << pdf;
    }
  EXPECT_TRUE(std::isnan(alone.lights.infinite_radiance<float>(0, {NAN, 0, 1}, true).g));
  EXPECT_TRUE(std::isnan(alone.lights.infinite_radiance<float>(0, {NAN, NAN, NAN}, true).g));
}

TEST(Envmap, RadianceOverDensityIsNearlyConstantWhereTheMapIsSmooth) {
  constexpr int width = 64, height = 32;
  std::vector<float> rgb;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int k = 0; k < 3; ++k)
        rgb.push_back(float(1.5 + std::sin(0.2 * j) * std::cos(i * std::numbers::pi / 32)));
  Alone smooth;
  add_envmap(smooth, width, height, rgb);
  RandomBits random(15);
  RunningStatistics ratio;
  for (int i = 0; i < samples; ++i) ratio.add(sample_of(smooth, random.square()).radiance_over_pdf.g);
  EXPECT_LT(std::sqrt(ratio.variance()), 0.01 * ratio.mean);

  // Where it is not, the ratio stays below 3 times the mean: sin(theta) against its interpolation.
  Alone rough;
  add_envmap(rough, 16, 9, random_map(16, 9, true));
  RunningStatistics rough_ratio;
  double largest = 0;
  for (int i = 0; i < samples; ++i) {
    const double luminance_over_pdf = luminance(sample_of(rough, random.square()).radiance_over_pdf);
    rough_ratio.add(luminance_over_pdf);
    largest = std::max(largest, luminance_over_pdf);
  }
  EXPECT_LT(largest, 3 * rough_ratio.mean);
}

/// One of the lights of a scene, all alike, and a sample of it.
LightSample<float> sample_lights(const Scene& scene, const Vec3f& from, const Vec2<std::uint32_t>& u) {
  const Receiver<float> receiver = receiver_at(from);
  const LightChoice<float> choice = UniformLights(scene.lights).choose<float>(receiver, u.x, 0);
  return scene.lights.sample<float>(choice.light, choice.pmf, receiver, {choice.u_left, u.y}, true);
}

/// Irradiance on a surface facing +z at the origin, from samples of all lights of a scene.
RunningStatistics sampled_irradiance(const Scene& scene, const Vec3f& at, unsigned seed) {
  RandomBits random(seed);
  RunningStatistics irradiance;
  for (int i = 0; i < samples; ++i) {
    const LightSample<float> sample = sample_lights(scene, at, random.square());
    irradiance.add(sample.is_there ? double(sample.radiance_over_pdf.g) * std::max(0.0f, sample.wi.z) : 0);
  }
  return irradiance;
}

LoadedScene scene_with(const std::string& lights, const std::vector<SceneFile>& files = {}) {
  return load_scene_text(camera_xml({0, 0, 0}, {0, 0, 1}, 30, 4, "independent") + lights +
                             rectangle_xml({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, ""),
                         files);
}

void expect_irradiance(const std::string& lights, const Vec3f& at, double exact,
                       const std::vector<SceneFile>& files = {}) {
  const LoadedScene loaded = scene_with(lights, files);
  const RunningStatistics irradiance = sampled_irradiance(loaded.scene, at, 16);
  if (irradiance.variance() < 1e-8 * exact * exact) {
    EXPECT_NEAR(irradiance.mean, exact, 1e-5 * exact) << lights;
    return;
  }
  const MeanTest test = t_test(irradiance, exact);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << lights << irradiance.mean << ", exact " << exact;
}

TEST(LightIrradiance, OfLightsWithoutAreaIsExact) {
  constexpr double pi_d = std::numbers::pi;
  const double distance = std::sqrt(1.0 + 4 + 9), cosine = 3 / distance;
  expect_irradiance(R"(<luminaire type="point"><point name="position" value="1,2,3"/>
    <color name="power" value="5,7,9"/></luminaire>)",
                    {0, 0, 0}, 7 / (4 * pi_d) / (distance * distance) * cosine);
  expect_irradiance(R"(<luminaire type="point"><color name="intensity" value="5,7,9"/>
    <transform name="toWorld"><translate value="1,2,3"/></transform></luminaire>)",
                    {0, 0, 0}, 7 / (distance * distance) * cosine);
  expect_irradiance(R"(<luminaire type="directional"><vector name="direction" value="0,-3,-4"/>
    <color name="irradiance" value="7"/></luminaire>)",
                    {3, 1, 2}, 7 * 0.8);
  expect_irradiance(R"(<luminaire type="directional"><color name="radiance" value="7"/>
    <transform name="toWorld"><lookat origin="0,3,4" target="0,0,0" up="0,0,1"/></transform></luminaire>)",
                    {3, 1, 2}, 7 * 0.8);
  // Spots: on the axis; half way between 30 and 50 degrees; outside.
  const std::string spot = R"(<luminaire type="spot"><color name="intensity" value="8"/>
    <float name="cutoffAngle" value="50"/><float name="beamWidth" value="30"/>
    <transform name="toWorld"><lookat origin="0,0,2" target="0,0,0" up="0,1,0"/></transform></luminaire>)";
  expect_irradiance(spot, {0, 0, 0}, 8 / 4.0);
  const double t = std::tan(40 * pi_d / 180), slant_sq = 4 * (1 + t * t);
  expect_irradiance(spot, {0, float(2 * t), 0}, 0.5 * 8 / slant_sq * 2 / std::sqrt(slant_sq));
  const LoadedScene outside = scene_with(spot);
  EXPECT_EQ(sampled_irradiance(outside.scene, {3, 0, 0}, 17).mean, 0);
  EXPECT_EQ(sampled_irradiance(outside.scene, {0, 0, 3}, 17).mean, 0);
}

TEST(LightIrradiance, OfLightsAtInfinityIsExact) {
  constexpr double pi_d = std::numbers::pi;
  expect_irradiance(R"(<luminaire type="constant"><color name="radiance" value="2"/></luminaire>)", {0, 0, 0},
                    2 * pi_d);
  for (const double half_angle : {5.0, 60.0, 90.0}) {
    const double sine = std::sin(half_angle / 180 * pi_d);
    expect_irradiance(fmt::format(R"(<luminaire type="distantdisk"><color name="radiance" value="2"/>
      <float name="thetaA" value="{}"/></luminaire>)",
                                  half_angle),
                      {0, 0, 0}, 2 * pi_d * sine * sine);
  }
  // All directions; half of the upper ones; and from below, nothing.
  expect_irradiance(R"(<luminaire type="distantdisk"><color name="radiance" value="2"/>
    <float name="thetaA" value="180"/></luminaire>)",
                    {0, 0, 0}, 2 * pi_d);
  expect_irradiance(R"(<luminaire type="distantdisk"><color name="radiance" value="2"/>
    <float name="thetaA" value="90"/><transform name="toWorld"><rotate axis="1,0,0" angle="90"/></transform>
    </luminaire>)",
                    {0, 0, 0}, pi_d);
}

/// The bytes of an EXR image, as a file beside a scene.
SceneFile exr_file(const std::string& name, int width, int height, const std::vector<float>& rgb) {
  Image image{width, height, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (std::size_t i = 0; i < rgb.size(); ++i) image.channels[i % 3].values.push_back(rgb[i]);
  const test::TemporaryFolder folder;
  write_exr(folder.path() / name, image);
  std::ifstream stream(folder.path() / name, std::ios::binary);
  return {name, {std::istreambuf_iterator<char>(stream), {}}};
}

TEST(LightIrradiance, OfAnEnvironmentMapIsThatOfItsTexels) {
  constexpr int width = 16, height = 9;
  const std::vector<float> rgb = random_map(width, height, true);
  const auto texel = [&](int i, int j) {
    return double(rgb[std::size_t(3 * (std::clamp(j, 0, height - 1) * width + (i + width) % width) + 1)]);
  };
  // Quadrature of the bilinear map, by the midpoint rule; z is up after a turn about x.
  constexpr int steps = 60;
  double exact = 0;
  for (int j = 0; j < height * steps; ++j)
    for (int i = 0; i < width * steps; ++i) {
      const double u = (i + 0.5) / (width * steps), v = (j + 0.5) / (height * steps);
      const double x = u * width - 0.5, y = v * height - 0.5;
      const int i0 = int(std::floor(x)), j0 = int(std::floor(y));
      const double s = x - i0, t = y - j0, theta = v * std::numbers::pi;
      const double radiance = (1 - t) * ((1 - s) * texel(i0, j0) + s * texel(i0 + 1, j0)) +
                              t * ((1 - s) * texel(i0, j0 + 1) + s * texel(i0 + 1, j0 + 1));
      exact += radiance * std::max(0.0, std::cos(theta)) * std::sin(theta) * 2 *
               std::pow(std::numbers::pi / (height * steps), 2) * (double(height) / width);
    }
  expect_irradiance(R"(<luminaire type="envmap"><string name="filename" value="map.exr"/>
    <float name="scale" value="3"/><transform name="toWorld"><rotate axis="1,0,0" angle="90"/></transform>
    </luminaire>)",
                    {0, 0, 0}, 3 * exact, {exr_file("map.exr", width, height, rgb)});
}

TEST(LightIrradiance, OfSeveralKindsTogetherAddsUp) {
  expect_irradiance(R"(<luminaire type="constant"><color name="radiance" value="2"/></luminaire>
    <luminaire type="directional"><vector name="direction" value="0,-3,-4"/></luminaire>)" +
                        rectangle_xml({0, 0, 2}, {0.5, 0, 0}, {0, -0.5, 0}, light_xml(3)) +
                        sphere_xml({1, 0, 3}, 0.2, R"(<luminaire type="point">
                          <point name="position" value="0,0,4"/><color name="intensity" value="16"/></luminaire>)"),
                    {0, 0, 0},
                    2 * std::numbers::pi + 0.8 + 1 +
                        polygon_irradiance(rectangle_corners({0, 0, 2}, {0.5, 0, 0}, {0, -0.5, 0}), 3,
                                           {0, 0, 0}, {0, 0, 1}));
}

TEST(SpotLight, SendsOutItsPower) {
  for (const double cutoff_deg : {20.0, 50.0, 180.0})
    for (const double beam_deg : {0.0, 0.5 * cutoff_deg, cutoff_deg}) {
      const LoadedScene loaded = scene_with(fmt::format(
          R"(<luminaire type="spot"><color name="power" value="12"/><float name="cutoffAngle" value="{}"/>
          <float name="beamWidth" value="{}"/></luminaire>)",
          cutoff_deg, beam_deg));
      // On a sphere of radius 2 about it, in rings: radiance over density is the irradiance that faces it.
      constexpr int rings = 20000;
      double power = 0;
      for (int i = 0; i < rings; ++i) {
        const double angle = (i + 0.5) / rings * std::numbers::pi;
        const LightSample<float> sample = sample_lights(
            loaded.scene, {float(2 * std::sin(angle)), 0, float(2 * std::cos(angle))}, {1u << 31, 1u << 31});
        if (!sample.is_there) continue;
        EXPECT_EQ(sample.pdf_solid_angle, std::numeric_limits<float>::infinity());
        power += sample.radiance_over_pdf.g * 4 * 2 * std::numbers::pi * std::sin(angle) * std::numbers::pi /
                 rings;
      }
      EXPECT_NEAR(power, 12, 12 * 1e-3) << cutoff_deg << ", " << beam_deg;
    }
}

TEST(LightSample, EndsOnTheLightOrBeyondTheScene) {
  const LoadedScene loaded = scene_with(R"(<luminaire type="constant"/><luminaire type="directional"/>
    <luminaire type="point"><point name="position" value="3,4,5"/></luminaire>)");
  const Sphere bounds = bounding_sphere(loaded.scene.geometry);
  RandomBits random(18);
  for (const Vec3f& at : {Vec3f{0, 0, 0}, Vec3f{0.5f, 0.5f, -1}, Vec3f{-40, 0, 3}, Vec3f{1e4f, 1, 1}})
    for (int i = 0; i < 1000; ++i) {
      const LightSample<float> sample = sample_lights(loaded.scene, at, random.square());
      ASSERT_TRUE(sample.is_there);
      if (sample.light == 2) {
        ASSERT_EQ(sample.end, (Vec3f{3, 4, 5}));
      } else {
        // Without its last 1 / 10000, too.
        const Vec3d last = wide(at) + (wide(sample.end) - wide(at)) * (1 - 1e-4);
        const double along = dot(wide(bounds.center) - wide(at), wide(sample.wi));
        ASSERT_GE(length(last - wide(at)), along + double(bounds.radius));
        ASSERT_GT(length(last - wide(bounds.center)), 0.999 * double(bounds.radius));
      }
    }
}

TEST(LightSample, HasTheProbabilityOfItsLightInIt) {
  const LoadedScene loaded =
      scene_with(R"(<luminaire type="constant"><color name="radiance" value="2"/></luminaire>
    <luminaire type="constant"><color name="radiance" value="5"/></luminaire>)");
  RandomBits random(21);
  const LightSample<float> chosen = sample_lights(loaded.scene, {0, 0, 0}, random.square());
  EXPECT_NEAR(chosen.pdf_solid_angle * 8 * std::numbers::pi, 1, 1e-6);
  for (const std::int32_t light : {0, 1}) {
    const LightSample<float> sample =
        loaded.scene.lights.sample<float>(light, 1, receiver_at({0, 0, 0}), {12345u << 16, 99u << 20}, true);
    EXPECT_EQ(sample.light, light);
    EXPECT_NEAR(sample.pdf_solid_angle * 4 * std::numbers::pi, 1, 1e-6) << "here that is 1";
    EXPECT_NEAR(sample.radiance_over_pdf.g / (4 * std::numbers::pi), light == 0 ? 2 : 5, 1e-5);
    EXPECT_NEAR((loaded.scene.lights.infinite_pdf_solid_angle<float>(light, receiver_at({0, 0, 0}), sample.wi,
                                                                     true)) *
                    4 * std::numbers::pi,
                1, 1e-6);
  }
}

TEST(InversionTable, ChoosesByShareAndKeepsTheOrder) {
  std::mt19937 engine(19);
  std::uniform_real_distribution<double> uniform;
  for (const std::size_t count : {1, 2, 3, 7, 64, 1000}) {
    std::vector<double> weights;
    for (std::size_t i = 0; i < count; ++i)
      weights.push_back(i % 5 == 3 ? 0 : std::pow(10, -3 * uniform(engine)));
    std::vector<std::int32_t> shares;
    append_cumulative_shares(weights, shares);
    ASSERT_EQ(shares.size(), count + 1);
    EXPECT_EQ(shares.back(), inversion_whole);
    const std::int32_t n = std::int32_t(count);
    std::vector<double> observed(count), expected;
    RandomBits random(20);
    for (int i = 0; i < samples; ++i) {
      const auto chosen = sample_by_inversion<float>(shares.data(), 0, n, random.square().x);
      ASSERT_TRUE(chosen.index >= 0 && chosen.index < n);
      ASSERT_TRUE(chosen.u_left >= 0 && chosen.u_left < 1);
      ++observed[std::size_t(chosen.index)];
    }
    double total = 0;
    for (std::int32_t i = 0; i < n; ++i) {
      expected.push_back(samples * double(inversion_pmf<float>(shares.data(), 0, i)));
      total += expected.back();
    }
    EXPECT_NEAR(total / samples, 1, 1e-5);
    if (count > 1) expect_counts(observed, expected, std::to_string(count) + " entries");
    for (const std::uint32_t u : {0u, ~0u})
      EXPECT_GT(
          (inversion_pmf<float>(shares.data(), 0, sample_by_inversion<float>(shares.data(), 0, n, u).index)),
          0);
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
    const LightSample<float> sample = sample_lights(scene, {0, 0, 0}, random.square());
    irradiance.add(sample.is_there ? double(sample.radiance_over_pdf.g) * std::max(0.0f, sample.wi.z) : 0);
    if (!sample.is_there) continue;
    const std::int32_t light = sample.light;
    const Vec3f ng = light == 1   ? Vec3f(normalize(sample.end - Vec3f{1, 2, 1}))
                     : light == 0 ? Vec3f{float(normalize(cross(half_u, half_v)).x),
                                          float(normalize(cross(half_u, half_v)).y),
                                          float(normalize(cross(half_u, half_v)).z)}
                                  : Vec3f{1, 0, 0};
    const Vec3f on_light = light == 1 ? Vec3f{1, 2, 1} + ng * 0.7f : sample.end;
    const float pdf = scene.lights.pdf_solid_angle<float>(light, 1.0f / 3, receiver_at({0, 0, 0}),
                                                          {on_light, ng, sample.wi, 0}, true);
    ASSERT_NEAR(sample.pdf_solid_angle / pdf, 1, 2e-4) << "light " << light;
  }
  const MeanTest test = t_test(irradiance, exact);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << irradiance.mean << ", exact " << exact;
}

// --- Power and bounds ---

/// One light of each kind, by its number among the kinds; strength 2.
const char* const light_of_each_kind[] = {
    R"(<mesh type="obj"><string name="filename" value="roof.obj"/><luminaire type="area">
      <color name="radiance" value="2"/></luminaire></mesh>)",
    R"(<shape type="rectangle"><transform name="toWorld"><rotate axis="1,2,0" angle="50"/>
      <scale value="0.4,0.7,1"/></transform><luminaire type="area"><color name="radiance" value="2"/></luminaire>
      </shape>)",
    R"(<shape type="sphere"><point name="center" value="0.2,0.3,0.1"/><float name="radius" value="0.4"/>
      <luminaire type="area"><color name="radiance" value="2"/></luminaire></shape>)",
    R"(<shape type="disk"><transform name="toWorld"><scale value="0.5,0.3,1"/><rotate axis="1,1,0" angle="40"/>
      </transform><luminaire type="area"><color name="radiance" value="2"/></luminaire></shape>)",
    R"(<luminaire type="point"><point name="position" value="0.2,0.1,0.3"/><color name="intensity" value="2"/>
      </luminaire>)",
    R"(<luminaire type="spot"><color name="intensity" value="2"/><float name="cutoffAngle" value="70"/>
      <float name="beamWidth" value="30"/><vector name="direction" value="1,2,-1"/></luminaire>)",
    R"(<luminaire type="directional"><vector name="direction" value="1,2,-1"/>
      <color name="irradiance" value="2"/></luminaire>)",
    R"(<luminaire type="distantdisk"><color name="radiance" value="2"/><float name="thetaA" value="40"/>
      </luminaire>)",
    R"(<luminaire type="envmap"><string name="filename" value="map.exr"/><float name="scale" value="2"/>
      </luminaire>)",
    R"(<shape type="rectangle"><transform name="toWorld"><rotate axis="1,2,0" angle="50"/>
      <scale value="0.4,0.7,1"/></transform><luminaire type="area"><texture type="imagetexture" name="radiance">
      <string name="filename" value="map.exr"/></texture><float name="scale" value="2"/></luminaire>
      </shape>)"};
static_assert(std::size(light_of_each_kind) == light_kind_count, "a kind of light is not tested");

LoadedScene scene_of_kind(std::size_t kind) {
  return scene_with(
      light_of_each_kind[kind],
      {{"roof.obj", "v -1 -1 0\nv 1 -1 0\nv 1 0 0.7\nv -1 0 0.7\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\nf 4 3 5 6\n"},
       exr_file("map.exr", 16, 9, random_map(16, 9, true))});
}

/// All that leaves the scene through a large sphere about it, by the light samples of receivers there; or, of
/// lights at infinity, what passes the cross-section of the scene.
TEST(LightPower, IsWhatLightSamplesAddUpTo) {
  std::mt19937 engine(23);
  std::normal_distribution<double> normal;
  RandomBits random(24);
  for (std::size_t kind = 0; kind < light_kind_count; ++kind) {
    const LoadedScene loaded = scene_of_kind(kind);
    const Lights& lights = loaded.scene.lights;
    ASSERT_EQ(lights.count(), 1);
    const bool is_infinite = !lights.bounds(0);
    const double radius = is_infinite ? bounding_sphere(loaded.scene.geometry).radius : 50;
    RunningStatistics power;
    for (int i = 0; i < samples; ++i) {
      const Vec3d d = normalize(Vec3d{normal(engine), normal(engine), normal(engine)});
      const Vec3d at = is_infinite ? Vec3d{0, 0, 0} : d * radius;
      const LightSample<float> sample = lights.sample<float>(
          0, 1, receiver_at({float(at.x), float(at.y), float(at.z)}), random.square(), true);
      const double arriving = sample.is_there ? luminance(sample.radiance_over_pdf) : 0;
      // On the sphere each sample counts with its cosine to the surface, facing the light.
      const double facing = is_infinite ? 1 : std::max(0.0, -dot(wide(sample.wi), d));
      power.add(arriving * facing * (is_infinite ? 1 : 4) * std::numbers::pi * radius * radius);
    }
    if (power.variance() < 1e-8 * power.mean * power.mean) {
      EXPECT_NEAR(lights.power(0), power.mean, 1e-4 * power.mean) << "kind " << kind;
      continue;
    }
    const MeanTest test = t_test(power, lights.power(0));
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << "kind " << kind << ": " << power.mean << " +- " << power.standard_error() << ", stated "
        << lights.power(0);
  }
}

/// Every sample ends in the box; and no receiver beyond the cones of normals and emission is lit.
TEST(LightBounds, HoldAllOfTheLight) {
  std::mt19937 engine(25);
  std::normal_distribution<double> normal;
  RandomBits random(26);
  for (std::size_t kind = 0; kind < light_kind_count; ++kind) {
    const LoadedScene loaded = scene_of_kind(kind);
    const std::optional<LightBounds> bounds = loaded.scene.lights.bounds(0);
    if (!bounds) continue;
    EXPECT_NEAR(length(wide(bounds->axis)), 1, 1e-5) << "kind " << kind;
    int lit = 0;
    double least_cosine = 1;
    const double widest = std::acos(double(bounds->cos_normals)) + std::acos(double(bounds->cos_emission));
    for (int i = 0; i < samples; ++i) {
      const Vec3d d = normalize(Vec3d{normal(engine), normal(engine), normal(engine)}) * 3.0;
      const LightSample<float> sample = loaded.scene.lights.sample<float>(
          0, 1, receiver_at({float(d.x), float(d.y), float(d.z)}), random.square(), true);
      if (!sample.is_there) continue;
      ++lit;
      const double slack = 1e-5;
      for (const auto axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
        ASSERT_GE(sample.end.*axis, bounds->box.low.*axis - slack) << "kind " << kind;
        ASSERT_LE(sample.end.*axis, bounds->box.high.*axis + slack) << "kind " << kind;
      }
      const double cosine = -dot(wide(sample.wi), wide(bounds->axis));
      least_cosine = std::min(least_cosine, cosine);
      ASSERT_LE(std::acos(std::clamp(cosine, -1.0, 1.0)), widest + 1e-3) << "kind " << kind;
    }
    EXPECT_GT(lit, 1000) << "kind " << kind;
    // Not much wider than need be.
    EXPECT_LT(std::acos(least_cosine), widest + 1e-3) << "kind " << kind;
    EXPECT_GT(std::acos(least_cosine), std::min(widest, std::numbers::pi) - 0.2) << "kind " << kind;
  }
}

}  // namespace
}  // namespace etendue

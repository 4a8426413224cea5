// What paths carry from vertex to vertex stays right over 10,000 vertices: the stages of the path integrators
// without an end by roulette, which would hide all errors that grow.
//
// Seen to fail when: directions are not made unit; the weight of what is refracted is 1e-6 too large; a
// mirror keeps 1 - 1e-6 of the light.
#include "integrator/bsdf_stage.h"
#include "integrator/hit_stage.h"
#include "test_scene.h"

#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace etendue {
namespace {

constexpr int vertices = 10000, paths = 64;
/// Of a product in which each vertex rounds once.
constexpr double rounded = vertices * 0x1p-24;

struct Carried {
  int count;                ///< Paths that are left of all.
  double direction_error;   ///< Largest difference of the length of a direction from 1, at any vertex.
  double throughput_error;  ///< Largest difference of throughput times eta^2 from 1, in the end.
  double eta_error;         ///< Of eta from a power of the index of refraction, in the end, as a power.
  bool is_finite;
};

/// \param index of refraction of the glass there is
Carried carried_through(const std::string& things, double index = 1.5) {
  const Scene scene =
      load_scene_text(camera_xml({0.3, -0.2, 0.1}, {1, 0.5, 0.7}, 60, 8, "independent") + things).scene;
  const auto block = std::make_unique<SampleBlock>();
  block->count = block->padded_count = paths;
  for (int i = 0; i < paths; ++i) {
    block->pixel_x[i] = i % 8;
    block->pixel_y[i] = i / 8;
    block->path.sample[i] = i;
    block->path.stream_lo[i] = 7;
    block->path.stream_hi[i] = std::uint32_t(i);
  }
  camera_rays<float>(scene, *block);
  const PathRules rules = PathRules::paths(ByBsdf{});
  const PathColumns& path = block->path;
  Carried carried{0, 0, 0, 0, true};
  for (int vertex = 0; vertex < vertices && path.count > 0; ++vertex) {
    for (int i = 0; i < path.padded_count; ++i) block->path.index[i] = std::uint32_t(vertex);
    closest_hits<float>(scene, *block, Coherence::incoherent);
    if (scene.medium) fly_through_medium<float>(scene, *block, 1);
    sample_bsdf<float>(scene, *block, rules, 1);  // As at a vertex before the first roulette.
    follow_paths<float>(*block, false);
    for (int i = 0; i < path.count; ++i)
      carried.direction_error = std::max(
          carried.direction_error, std::abs(double(length(load_lanes<float>(path.ray.direction, i))) - 1));
  }
  carried.count = path.count;
  for (int i = 0; i < path.count; ++i) {
    const double eta = path.eta[i];
    for (const float channel : {path.throughput.r[i], path.throughput.g[i], path.throughput.b[i]})
      carried.throughput_error = std::max(carried.throughput_error, std::abs(channel * eta * eta - 1));
    const double power = std::log(eta) / std::log(index);
    carried.eta_error = std::max(carried.eta_error, std::abs(power - std::round(power)));
  }
  for (int i = 0; i < paths; ++i) carried.is_finite &= std::isfinite(block->radiance.r[i]);
  return carried;
}

/// A closed room around the camera.
std::string room(const std::string& bsdf) {
  const auto wall = [&](const Vec3d& out, const Vec3d& u) {
    return rectangle_xml(out * 2, u * 2, cross(-out, u) * 2, bsdf);
  };
  return wall({1, 0, 0}, {0, 1, 0}) + wall({-1, 0, 0}, {0, 1, 0}) + wall({0, 1, 0}, {0, 0, 1}) +
         wall({0, -1, 0}, {0, 0, 1}) + wall({0, 0, 1}, {1, 0, 0}) + wall({0, 0, -1}, {1, 0, 0});
}

std::string cloud(double g) {
  return fmt::format(
      "<medium type=\"homogeneous\"><color name=\"sigmaS\" value=\"20\"/><transform name=\"toWorld\">"
      "<translate value=\"-.5,-.5,-.5\"/><scale value=\"3.9,3.9,3.9\"/></transform><phase type=\"hg\"><float "
      "name=\"g\" value=\"{}\"/></phase></medium>",
      g);
}

void expect_right(const Carried& carried, double bound) {
  EXPECT_EQ(carried.count, paths);
  EXPECT_TRUE(carried.is_finite);
  EXPECT_LT(carried.direction_error, 4e-7);
  EXPECT_LT(carried.throughput_error, bound);
  EXPECT_LT(carried.eta_error, bound);
}

const std::string mirror = "<bsdf type=\"mirror\"/>";

TEST(Drift, IsNoneInAHallOfMirrors) { expect_right(carried_through(room(mirror)), 1e-6); }

TEST(Drift, IsNoneInAWhiteRoom) { expect_right(carried_through(room(diffuse_xml(1))), 1e-6); }

TEST(Drift, IsNoneInClouds) {
  for (const double g : {-0.95, 0.0, 0.95}) {
    SCOPED_TRACE(g);
    expect_right(carried_through(room(mirror) + cloud(g)), rounded);
  }
}

TEST(Drift, IsLittleThroughGlass) {
  const std::string glass =
      "<bsdf type=\"dielectric\"><float name=\"intIOR\" value=\"1.5\"/><float name=\"extIOR\" "
      "value=\"1\"/></bsdf>";
  expect_right(carried_through(room(mirror) + sphere_xml({1, 0.5, 0.7}, 0.6, glass) +
                               sphere_xml({-0.8, 0.9, -0.6}, 0.8, glass)),
               rounded);
}

}  // namespace
}  // namespace etendue

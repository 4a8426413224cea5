#include "render/replay.h"

#include "base/error.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "support/program.h"

#include <cmath>
#include <gtest/gtest.h>

namespace etendue {
namespace {

LoadedScene small_scene(const std::string& more = "") {
  const test::TemporaryFolder folder;
  test::write_file(
      folder.path() / "scene.xml",
      "<scene>"
      "<camera type='perspective'><integer name='width' value='4'/><integer name='height' value='3'/>"
      "<transform name='toWorld'><lookat origin='0 0 4' target='0 0 0' up='0 1 0'/></transform></camera>"
      "<shape type='rectangle'><transform name='toWorld'><scale value='9'/></transform>"
      "<bsdf type='phong'/></shape>"
      "<shape type='sphere' name='lamp'><point name='center' value='1 0 1.5'/>"
      "<float name='radius' value='0.6'/><emitter type='area'/></shape>" +
          more + "</scene>");
  return load_scene(read_nori_xml(folder.path() / "scene.xml"));
}

void expect_sums_to_pixel(LoadedScene loaded, const IntegratorSettings& integrator) {
  for (const auto& [sampler, replicates_by] : {std::pair{SamplerKind::independent, ReplicatesBy::block},
                                               std::pair{SamplerKind::sobol, ReplicatesBy::block},
                                               std::pair{SamplerKind::sobol, ReplicatesBy::scrambling}}) {
    loaded.scene.sampler = sampler;
    RenderSettings settings;
    settings.integrator = integrator;
    settings.samples_per_pixel = 2;
    settings.replicates = 2;  // so that a replicate's mean is one sample's radiance
    settings.replicates_by = replicates_by;
    settings.seed = 11;
    const RenderResult result = render(loaded.scene, settings);
    int lit = 0;
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) {
        const Colorf first = replay(loaded.scene, settings, {x, y, 0, 0}).radiance;
        const Colorf second = replay(loaded.scene, settings, {x, y, 1, 0}).radiance;
        const PixelStatistics expected = combine_replicates(
            std::array{Color<double>{first.r, first.g, first.b}, Color<double>{second.r, second.g, second.b}},
            0);
        const PixelStatistics& pixel = result.film.at(x, y);
        EXPECT_EQ(pixel.mean.r, expected.mean.r) << x << "," << y;
        EXPECT_EQ(pixel.m2.g, expected.m2.g) << x << "," << y;
        EXPECT_EQ(pixel.m2.b, expected.m2.b) << x << "," << y;
        lit += first.r > 0;
      }
    EXPECT_GT(lit, 1);
  }
}

class Replay : public testing::TestWithParam<const char*> {};

TEST_P(Replay, SumsToThePixelOfTheScalarKernel) {
  expect_sums_to_pixel(small_scene(), integrator_from_name(GetParam()));
}

/// By cuts of the light tree, which hold every facet or not.
TEST(ReplayOfResampledLights, SumsToThePixelOfTheScalarKernel) {
  std::string lamps;
  for (int k = 0; k < 300; ++k)
    lamps += "<shape type='sphere'><point name='center' value='" + std::to_string(k % 20 - 10) + " " +
             std::to_string(k / 20 - 7) +
             " 2'/><float name='radius' value='0.05'/><emitter type='area'/></shape>";
  for (const char* integrator : {"direct_light", "path"}) {
    expect_sums_to_pixel(small_scene(), integrator_from_name(integrator));
    expect_sums_to_pixel(small_scene(lamps), integrator_from_name(integrator));
  }
}

TEST_P(Replay, SaysHowTheRadianceCameAbout) {
  const LoadedScene loaded = small_scene();
  RenderSettings settings;
  settings.integrator = integrator_from_name(GetParam());
  settings.samples_per_pixel = 64;
  settings.replicates = 2;
  const PathRules& rules = *settings.integrator.path_rules();
  for (int index = 0; index < 32; ++index) {
    const SampleTrace trace = replay(loaded.scene, settings, {1, 1, 1, index});
    EXPECT_NEAR(trace.x_px, 1.5, 2.5);
    EXPECT_NEAR(trace.y_px, 1.5, 2.5);
    EXPECT_NEAR(length(trace.ray_direction), 1, 1e-6);
    ASSERT_FALSE(trace.vertices.empty());
    const SampleTrace::Vertex& first = trace.vertices.front();
    ASSERT_TRUE(first.surface);
    EXPECT_EQ(first.light_sample.has_value(), rules.light_samples() != nullptr);
    EXPECT_EQ(first.bsdf_sample.has_value(), rules.bsdf_samples(0) > 0);
    if (first.surface->geometry == 0) {
      EXPECT_NEAR(first.position.z, 0, 5e-6);
    }
    if (first.light_sample) {
      EXPECT_NEAR(length(first.light_sample->end - Vec3f{1, 0, 1.5f}), 0.6, 1e-4);
      const float emission = first.surface->light >= 0 && dot(first.surface->ng, trace.ray_direction) < 0;
      EXPECT_EQ(first.radiance.r,
                emission + (first.light_sample->is_visible ? first.light_sample->unshadowed.r : 0));
    }
    if (first.bsdf_sample && first.bsdf_sample->is_followed) {
      ASSERT_GE(trace.vertices.size(), 2u);
      const SampleTrace::Vertex& second = trace.vertices[1];
      if (second.kind == SampleTrace::Vertex::Kind::surface) {
        EXPECT_NEAR(length(normalize(second.position - first.position) - first.bsdf_sample->direction), 0,
                    1e-3);
      }
      if (settings.integrator.name == "direct") {
        const bool meets_light = second.surface && second.surface->light >= 0 &&
                                 dot(second.surface->ng, first.bsdf_sample->direction) < 0;
        EXPECT_EQ(trace.radiance.r, first.radiance.r + (meets_light ? first.bsdf_sample->throughput.r : 0));
      }
    }
    EXPECT_EQ(trace.radiance, trace.vertices.back().radiance);
  }
}

TEST(ReplayOfSeveralBsdfSamples, SumsToThePixelOfTheScalarKernel) {
  for (const char* integrator : {"path", "path_mis", "direct"})
    expect_sums_to_pixel(small_scene(), with_bsdf_samples(integrator_from_name(integrator), 3));
}

TEST(ReplayOfSeveralBsdfSamples, NumbersVerticesAndBranches) {
  const LoadedScene loaded = small_scene();
  RenderSettings settings;
  settings.integrator = integrator_from_name("direct_mis");
  settings.integrator.rules = PathRules::direct(ByBoth{.bsdf_samples = 3});
  settings.samples_per_pixel = 8;
  settings.replicates = 1;
  const SampleTrace trace = replay(loaded.scene, settings, {1, 1, 0, 0});
  int left = 0;
  for (std::size_t i = 0; i < trace.vertices.size(); ++i) {
    const SampleTrace::Vertex& vertex = trace.vertices[i];
    if (vertex.number == 0) {
      EXPECT_EQ(vertex.branch, left++);
      ASSERT_TRUE(vertex.bsdf_sample);
    } else {
      ASSERT_GT(i, 0u);
      EXPECT_EQ(vertex.number, 1);
      EXPECT_EQ(vertex.branch, trace.vertices[i - 1].branch);
      EXPECT_TRUE(trace.vertices[i - 1].bsdf_sample->is_followed);
      EXPECT_FALSE(vertex.light_sample || vertex.bsdf_sample);
    }
  }
  EXPECT_EQ(left, 3);
  EXPECT_GT(trace.vertices.size(), 3u);
}

TEST(ReplayOfSeveralBsdfSamples, EachHasAFreeFlightOfItsOwn) {
  const LoadedScene loaded = small_scene(
      "<medium type='homogeneous'><color name='sigmaS' value='2'/><transform name='toWorld'><scale value='40 "
      "40 40'/>"
      "<translate value='-20 -20 -20'/></transform></medium>");
  RenderSettings settings;
  settings.integrator = integrator_from_name("direct_mis");
  settings.integrator.rules = PathRules::direct(ByBoth{.bsdf_samples = 4});
  settings.samples_per_pixel = 32;
  settings.replicates = 1;
  int scattered = 0;
  for (int index = 0; index < 32; ++index) {
    float last = 0;
    Vec3f at{};
    for (const SampleTrace::Vertex& vertex : replay(loaded.scene, settings, {1, 1, 0, index}).vertices) {
      if (vertex.number == 0) at = vertex.position;
      if (vertex.number == 0 || vertex.kind != SampleTrace::Vertex::Kind::medium) continue;
      const float flown = length(vertex.position - at);
      EXPECT_GT(std::abs(flown - last), 1e-4f * flown);
      last = flown;
      ++scattered;
    }
  }
  EXPECT_GT(scattered, 64);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Replay,
                         testing::Values("path", "light", "direct", "average", "mis", "path_mis", "path_ems",
                                         "path_mats", "whitted", "every_light"));

}  // namespace
}  // namespace etendue

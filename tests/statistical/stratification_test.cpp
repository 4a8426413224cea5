// Sobol points are worth it: at 64 samples a pixel the variance of every estimate is lower than that of
// independent points by a stated factor, for every light kind, integrator and light sampler, and for several
// samples.
//
// False-alarm rate of this file: 1e-6, fixed seeds. A bound is 0.5 of the factor measured (0.6 below 4), a
// ratio of two variances of 2048 degrees of freedom each; over seeds its logarithm has a standard deviation
// of 0.095 at most (0.044 by the F-distribution, were the means normal), so the bounds are 7 deviations away.
// Correlations: 6 deviations.
// Seen to fail when: the index of a sample is hashed; `all` takes index * lights + light of one sequence for
// all passes, or the same numbers for each; light and BSDF samples share a pair of dimensions, or vertices
// do; what the choice of a light leaves of its number is hashed; several light samples, or several BSDF
// samples, have hashed indices; each of several light samples has a sequence of its own; a candidate is
// chosen by a hash of its number, or candidates are.
#include "image/image_file.h"
#include "integrator/unlit.h"
#include "light/light_tables.h"
#include "test_scene.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <iterator>
#include <set>

namespace etendue {
namespace {

constexpr int samples = 64, side_px = 16, scramblings = 9;  ///< 2048 degrees of freedom.
constexpr double narrow_deg = 0.001;                        ///< All pixels see one point.
constexpr double wide_deg = 20;                             ///< The picture varies within each pixel.

struct SceneText {
  std::string body;
  std::vector<SceneFile> files;
};

/// A glossy floor, a low wall beside the middle that hides no light from it, and lights.
std::string corner_xml(const std::string& lights) {
  return rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, phong_xml(0.4, 0.4, 8)) +
         rectangle_xml({-1.5, 0, 0.8}, {0, 3, 0}, {0, 0, 0.8}, diffuse_xml(0.7)) + lights;
}

/// Of a pixel's mean of 64 samples, from its scramblings; mean over the pixels, that may differ.
double variance(const Film& film) {
  double sum = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) sum += film.at(x, y).m2.g / double(film.at(x, y).count - 1);
  return sum / (double(film.width()) * film.height());
}

RenderSettings settings_of(const IntegratorSettings& integrator) {
  RenderSettings settings = render_settings("light", samples * scramblings, scramblings, 17);
  settings.integrator = integrator;
  return settings;
}

struct Variances {
  double independent, sobol;
  double gain() const { return independent / sobol; }
};

Variances variances(const IntegratorSettings& integrator, double fov_deg, const SceneText& scene) {
  const auto with = [&](const char* sampler) {
    const LoadedScene loaded = load_scene_text(
        camera_xml({1.5, -2.5, 2}, {0, 0, 0}, fov_deg, side_px, sampler) + scene.body, scene.files);
    const RenderResult result = render(loaded.scene, settings_of(integrator));
    EXPECT_EQ(result.invalid.count(), 0);
    return variance(result.film);
  };
  return {with("independent"), with("sobol")};
}

void expect_gain(const Variances& variances, double bound, const std::string& what) {
  EXPECT_GT(variances.gain(), bound) << what << ": " << variances.independent << " by independent points, "
                                     << variances.sobol << " by Sobol points";
}

// Light kinds and integrators.

constexpr std::array integrators{"light",       "direct",       "average",  "mis",
                                 "every_light", "whitted",      "path_ems", "path_mats",
                                 "path_mis",    "direct_light", "path"};

/// What the integrators must gain, in their order; 0 for those that do not find the light.
using Bounds = std::array<double, integrators.size()>;

struct LightCase {
  const char* name;
  double fov_deg;
  SceneText lights;
  Bounds bounds;
};

const Vec3d center{0.3, 0.5, 1.2}, half_u{0.9, 0.1, 0.1}, half_v{0.1, -0.8, 0.1};

/// Smooth, brighter from above and from one side.
SceneFile envmap_file() {
  constexpr int width = 32, height = 16;
  Image map{width, height, {{"B", {}}, {"G", {}}, {"R", {}}}, {}};
  for (Channel& channel : map.channels)
    for (int i = 0; i < width * height; ++i)
      channel.values.push_back(1.5f + std::cos(0.2f * float(i % width)) * std::sin(0.2f * float(i / width)));
  const test::TemporaryFolder folder;
  write_exr(folder.path() / "map.exr", map);
  std::ifstream stream(folder.path() / "map.exr", std::ios::binary);
  return {"map.exr", {std::istreambuf_iterator<char>(stream), {}}};
}

/// In the order of LightKinds.
auto light_cases() {
  return std::array{
      LightCase{"mesh",
                narrow_deg,
                {mesh_xml("light.obj", light_xml(3)),
                 {{"light.obj", polygon_obj(rectangle_corners(center, half_u, half_v))}}},
                {41, 4.3, 5.0, 8.6, 41, 41, 4.5, 2.3, 2.5, 17, 1.6}},
      LightCase{"rectangle",
                narrow_deg,
                {rectangle_xml(center, half_u, half_v, light_xml(3)), {}},
                {180, 4.3, 5.1, 9.0, 180, 180, 4.9, 2.3, 2.6, 21, 1.6}},
      LightCase{"sphere",
                narrow_deg,
                {sphere_xml(center, 0.7, light_xml(3)), {}},
                {59, 2.8, 3.0, 3.2, 59, 59, 3.4, 2.1, 2.0, 7.2, 1.4}},
      LightCase{"disk",
                narrow_deg,
                {R"(<shape type="disk"><transform name="toWorld"><rotate axis="1,0,0" angle="170"/>
                    <translate value="0.3,0.5,1.2"/></transform>)" +
                     light_xml(3) + "</shape>",
                 {}},
                {97, 3.8, 4.3, 7.4, 97, 97, 3.5, 2.0, 2.1, 17, 1.5}},
      LightCase{"point",
                wide_deg,
                {R"(<emitter type="point"><point name="position" value="0.3,0.5,1.2"/></emitter>)", {}},
                {1900, 0, 1900, 1900, 1900, 1900, 2.0, 0, 2.0, 1900, 2.1}},
      LightCase{"spot",
                wide_deg,
                {R"(<emitter type="spot"><point name="position" value="0.3,0.5,1.2"/>
                    <vector name="direction" value="-0.2,-0.4,-1"/><float name="cutoffAngle" value="80"/>
                    <float name="beamWidth" value="1"/></emitter>)",
                 {}},
                {1900, 0, 1900, 1900, 1900, 1900, 1.3, 0, 1.3, 1900, 1.4}},
      LightCase{
          "directional",
          wide_deg,
          {R"(<emitter type="directional"><vector name="direction" value="-0.4,-0.9,-1"/></emitter>)", {}},
          {1900, 0, 1900, 1900, 1900, 1900, 1.3, 0, 1.3, 1900, 1.4}},
      LightCase{"distant_disk",
                narrow_deg,
                {R"(<emitter type="distantdisk"><float name="thetaA" value="40"/></emitter>)", {}},
                {44, 7.8, 8.5, 5.0, 44, 44, 5.2, 3.8, 2.4, 8.3, 1.6}},
      LightCase{
          "envmap",
          narrow_deg,
          {R"(<emitter type="envmap"><string name="filename" value="map.exr"/></emitter>)", {envmap_file()}},
          {2.1, 4.2, 2.2, 4.6, 2.1, 2.1, 2.2, 1.7, 2.1, 6.8, 1.0}},
      LightCase{"textured",
                narrow_deg,
                {rectangle_xml(center, half_u, half_v,
                               R"(<emitter type="area"><texture type="imagetexture" name="radiance">
                                  <string name="filename" value="map.exr"/></texture></emitter>)"),
                 {envmap_file()}},
                {4.8, 3.3, 3.5, 4.7, 4.8, 4.8, 3.1, 2.1, 2.5, 850, 0.95}}};
}
static_assert(std::tuple_size_v<decltype(light_cases())> == light_kind_count, "each kind needs a case");

class EveryLightKind : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EveryLightKind, GainsWithEveryIntegrator) {
  LightCase light = light_cases()[GetParam()];
  light.lights.body = corner_xml(light.lights.body);
  for (std::size_t k = 0; k < integrators.size(); ++k) {
    const Variances found = variances(integrator_from_name(integrators[k]), light.fov_deg, light.lights);
    if (light.bounds[k] > 0)
      expect_gain(found, light.bounds[k], integrators[k]);
    else
      EXPECT_TRUE(found.independent == 0 && found.sobol == 0) << integrators[k] << " finds it";
  }
}

std::string name_of_case(const ::testing::TestParamInfo<std::size_t>& info) {
  return light_cases()[info.param].name;
}
INSTANTIATE_TEST_SUITE_P(Named, EveryLightKind, ::testing::Range(std::size_t{0}, light_kind_count),
                         name_of_case);

TEST(Stratification, IsTestedOfEveryIntegrator) {
  std::set<std::string_view> tested(integrators.begin(), integrators.end()), all;
  for (const Plugin& plugin : integrator_plugins())
    if (!is_unlit(plugin.name)) all.insert(integrator_from_name(plugin.name).name);
  EXPECT_EQ(tested, all);
  // av and ao are below, and the others have no random numbers but the film's.
  EXPECT_EQ(unlit_plugins().size(), 5);
}

TEST(Stratification, OfOpenSky) {
  const SceneText scene{corner_xml(""), {}};
  for (const char* name : {"av", "ao"})
    expect_gain(variances(integrator_from_name(name), narrow_deg, scene), 4, name);
}

TEST(Stratification, LastsThroughAMirror) {
  // The camera sees a wall in the mirror.
  const SceneText scene{rectangle_xml({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "<bsdf type=\"mirror\"/>") +
                            rectangle_xml({-1.5, 2.5, 2}, {1, 0.5, 0}, {0, 0, 3}, diffuse_xml(0.7)) +
                            rectangle_xml({0.3, 0.5, 3.5}, half_u, half_v, light_xml(3)),
                        {}};
  expect_gain(variances(integrator_from_name("whitted"), narrow_deg, scene), 310, "whitted");
}

// Several lights, several samples.

/// Rectangles around the middle, of mixed radiance.
SceneText several_lights(int count) {
  std::string lights;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    lights += rectangle_xml({0.4 + 0.6 * std::cos(angle), 0.6 * std::sin(angle), 1.2 + 0.1 * k},
                            {0.4, 0, 0.1}, {0, -0.4, 0}, light_xml(3 + 2 * k));
  }
  return {corner_xml(lights), {}};
}

struct LightSamplerCase {
  std::string_view name;
  double bounds[2][3];  ///< Of 3 and 4 lights; by light, mis and path_ems.
};
constexpr LightSamplerCase light_sampler_cases[]{{"uniform", {{7.8, 3.1, 3.5}, {20, 3.9, 3.7}}},
                                                 {"power", {{8.9, 2.7, 3.3}, {6.1, 2.6, 2.3}}},
                                                 {"all", {{730, 4.1, 2.1}, {33, 5.6, 1.7}}},
                                                 {"tree", {{10, 2.6, 2.6}, {3.5, 2.3, 2.2}}}};

TEST(Stratification, OfEveryLightSampler) {
  ASSERT_EQ(std::size(light_sampler_cases), light_sampler_plugins().size()) << "each needs a case";
  for (const LightSamplerCase& sampler : light_sampler_cases)
    for (int k = 0; k < 2; ++k)
      for (int m = 0; m < 3; ++m) {
        const char* integrator = std::array{"light", "mis", "path_ems"}[std::size_t(m)];
        expect_gain(variances(with_light_sampler(integrator_from_name(integrator), sampler.name), narrow_deg,
                              several_lights(3 + k)),
                    sampler.bounds[k][m], fmt::format("{}, {} lights, {}", sampler.name, 3 + k, integrator));
      }
}

TEST(Stratification, OfSeveralLightSamplesAndBsdfSamples) {
  // By the number of light samples, then of BSDF samples.
  constexpr double bounds[5][4]{{0, 1.8, 2.3, 2.1},
                                {7.8, 3.1, 2.8, 3.0},
                                {15, 5.0, 4.0, 3.9},
                                {15, 6.1, 4.8, 4.6},
                                {30, 8.6, 6.2, 5.7}};
  for (int light_samples = 0; light_samples <= 4; ++light_samples)
    for (int bsdf_samples = light_samples == 0 ? 1 : 0; bsdf_samples <= 3; ++bsdf_samples) {
      const LightSamples lights{.count = light_samples};
      const PathRules rules = bsdf_samples == 0 ? PathRules::direct(ByLights{lights})
                              : light_samples == 0
                                  ? PathRules::direct(ByBsdf{bsdf_samples})
                                  : PathRules::direct(ByBoth{Heuristic::balance, lights, bsdf_samples});
      expect_gain(variances({"mis", rules}, narrow_deg, several_lights(3)),
                  bounds[light_samples][bsdf_samples],
                  fmt::format("{} light samples, {} BSDF samples", light_samples, bsdf_samples));
    }
}

// Resampling keeps the points stratified.

struct ViewCase {
  const char* name;
  SceneText scene;
  int candidates;
  /// Over the same for `light`: what variance times samples at 16 and 64 samples may be of that at 4.
  double slack_16, slack_64;
  double most_16, most_64;  ///< And by itself.
};

std::vector<ViewCase> views() {
  const std::string ball = sphere_xml({0.3, 0.2, -0.6}, 0.35, diffuse_xml(0.6));
  const SceneText box{mesh_xml("room.obj", diffuse_xml(0.7)) + ball +
                          rectangle_xml({0, 0, 0.98}, {0.3, 0, 0}, {0, -0.3, 0}, light_xml(5)),
                      {{"room.obj", box_obj({0, 0, 0}, 1, true)}}};
  std::string lamps;
  for (int k = 0; k < 400; ++k)
    lamps += rectangle_xml({-0.95 + 0.1 * (k % 20), -0.95 + 0.1 * (k / 20), 0.5 + 0.02 * (k % 7)},
                           {0.02, 0, 0.01}, {0, -0.02, 0}, light_xml(1 + k % 11));
  const SceneText many{mesh_xml("room.obj", diffuse_xml(0.7)) + ball + lamps, box.files};
  // Candidates of one lamp are alike: a choice among them costs more than it brings, and `settled` makes
  // none.
  return {{"box", box, 1, 1.1, 1.1, 0.5, 0.4},
          {"box", box, 4, 1.7, 2.0, 0.7, 0.65},
          {"many lamps", many, 4, 1.1, 1.1, 0.95, 0.7}};
}

TEST(Stratification, IsKeptByResampling) {
  const auto variance_of = [](const SceneText& scene, IntegratorSettings integrator, int spp) {
    const LoadedScene loaded =
        load_scene_text(camera_xml({0, -0.9, 0}, {0, 1, -0.3}, 70, 24, "sobol") + scene.body, scene.files);
    RenderSettings settings = settings_of(integrator);
    settings.samples_per_pixel = spp * scramblings;
    return variance(render(loaded.scene, settings).film);
  };
  for (const ViewCase& view : views()) {
    LightSamples lights = *integrator_from_name("direct_light").path_rules()->light_samples();
    lights.candidates = view.candidates;
    lights.technique = LightTechnique::area;  // As of `light`.
    const IntegratorSettings light = integrator_from_name("light"),
                             resampled{"direct_light", integrator_from_name("direct_light")
                                                           .path_rules()
                                                           ->with_light_samples(lights)};
    const auto fall = [&](const IntegratorSettings& integrator, int spp) {
      return variance_of(view.scene, integrator, spp) * spp / (variance_of(view.scene, integrator, 4) * 4);
    };
    for (const int spp : {16, 64}) {
      const double of_light = fall(light, spp), of_resampled = fall(resampled, spp);
      EXPECT_LT(of_resampled, of_light * (spp == 16 ? view.slack_16 : view.slack_64))
          << view.name << ", " << view.candidates << " candidates, " << spp << " samples: " << of_light
          << " of light, " << of_resampled << " resampled";
      EXPECT_LT(of_resampled, spp == 16 ? view.most_16 : view.most_64)
          << view.name << ", " << view.candidates << " candidates, " << spp << " samples";
    }
  }
}

// Random numbers are shared by no two consumers.

/// Of the errors of two films whose pixels all have the same expectation.
double correlation(const Film& a, const Film& b) {
  const double mean_a = a.mean().g, mean_b = b.mean().g;
  double aa = 0, bb = 0, ab = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      const double da = a.at(x, y).mean.g - mean_a, db = b.at(x, y).mean.g - mean_b;
      aa += da * da;
      bb += db * db;
      ab += da * db;
    }
  return ab / std::sqrt(aa * bb);
}

TEST(RandomNumbers, OfLightSamplesAreIndependentOfEachOtherAndOfBsdfSamples) {
  constexpr int lights = 3, pixels_px = 64;
  constexpr std::int32_t none = LayerSet::none;
  LayerSet by_light{.light_parts = lights, .light_part = {}, .path_part = {{{none, 0, none}, {none}}}};
  std::vector<std::string> names;
  for (std::int32_t light = 0; light < lights; ++light) {
    by_light.light_part.push_back(light);
    names.push_back(fmt::format("sample of light {}", light));
  }
  const LayerSet others{
      .path_parts = 2, .light_part = {}, .path_part = {{{none, none, 1, none}, {none, 0, none}}}};
  names.insert(names.end(), {"BSDF sample", "samples at the next vertex"});
  for (const char* sampler : {"independent", "sobol"}) {
    const LoadedScene loaded = load_scene_text(
        camera_xml({1.5, -2.5, 2}, {0, 0, 0}, narrow_deg, pixels_px, sampler) + several_lights(lights).body);
    RenderSettings settings = settings_of(with_light_sampler(integrator_from_name("path_mis"), "all"));
    settings.samples_per_pixel = samples;
    settings.replicates = 1;
    settings.layers = {by_light, others};
    const std::vector<Film> films = render(loaded.scene, settings).layers;
    for (std::size_t a = 0; a < lights; ++a)
      for (std::size_t b = a + 1; b < films.size(); ++b) {
        EXPECT_NEAR(correlation(films[a], films[b]), 0, 6.0 / pixels_px)
            << sampler << ": " << names[a] << ", " << names[b];
      }
  }
}

}  // namespace
}  // namespace etendue

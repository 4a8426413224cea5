// Layers of an image: parts by technique, light and depth that add up to it, and of which each is what it is
// called.
//
// No test of this file can fail by chance: where layers are other images, they are so bit for bit.
// Seen to fail when: light samples count as BSDF samples, or light that is met as light samples; depths of
// either are one off; a light's id is the piece of it; layers are not emptied for the next block; they lack
// the filter's weights; they keep what invalid samples had.
#include "render/image_layers.h"
#include "test_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>

namespace etendue {
namespace {

constexpr int side_px = 48, samples = 16;

constexpr std::int32_t light_count = 4;
enum LightId : std::int32_t { rectangle, sphere, point, sky };

struct SceneParts {
  std::array<double, light_count> strength{6, 40, 5, 0.3};  ///< By light.
  bool is_black = false;                                    ///< All surfaces, the mirror too.
  bool has_mist = true;
  const char* filter = "box";
};

LoadedScene scene_of(const SceneParts& parts = {}) {
  const auto bsdf = [&](double albedo) { return diffuse_xml(parts.is_black ? 0 : albedo); };
  std::string camera = camera_xml({0, -6, 2.5}, {0, 0, 0.7}, 45, side_px, "sobol");
  const std::string box = "<rfilter type=\"box\"/>";
  camera.replace(camera.find(box), box.size(), fmt::format("<rfilter type=\"{}\"/>", parts.filter));
  std::string text = camera + rectangle_xml({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, bsdf(0.6)) +
                     rectangle_xml({0, 3, 2}, {4, 0, 0}, {0, 0, 2}, bsdf(0.5)) +
                     rectangle_xml({-2, 0, 3}, {0.7, 0, 0.2}, {0, -0.5, 0},
                                   light_xml(parts.strength[rectangle]) + bsdf(0.5)) +
                     sphere_xml({0.5, 0.5, 1.4}, 0.1, light_xml(parts.strength[sphere]) + bsdf(0.1)) +
                     sphere_xml({1, -0.5, 0.6}, 0.6, bsdf(0.4)) +
                     fmt::format(
                         "<emitter type=\"point\"><color name=\"intensity\" value=\"{}\"/><point "
                         "name=\"position\" value=\"2,-1,3\"/></emitter>\n"
                         "<emitter type=\"constant\"><color name=\"radiance\" value=\"{}\"/></emitter>\n",
                         parts.strength[point], parts.strength[sky]);
  text += rectangle_xml({-2.5, 1, 1.5}, {0.3, 1, 0}, {0, 0, 1},
                        parts.is_black ? bsdf(0) : "<bsdf type=\"mirror\"/>");
  if (parts.has_mist)
    text +=
        "<medium type=\"homogeneous\"><color name=\"sigmaA\" value=\"0.02\"/><color name=\"sigmaS\" "
        "value=\"0.1,0.15,0.2\"/><transform name=\"toWorld\"><scale value=\"3,3,2\"/><translate "
        "value=\"-2,-1,0.1\"/></transform></medium>\n";
  return load_scene_text(text);
}

/// Each replicate is one sample, so that a pixel's variance tells how large its samples are.
RenderSettings settings_of(std::string_view integrator, const std::vector<LayerSet>& layers = {}) {
  RenderSettings settings = render_settings(integrator, samples, samples, 3);
  settings.replicates_by = ReplicatesBy::block;
  settings.layers = layers;
  return settings;
}

Film image(const SceneParts& parts, std::string_view integrator) {
  return render(scene_of(parts).scene, settings_of(integrator)).film;
}
Film layer(const SceneParts& parts, std::string_view integrator, const LayerSet& set) {
  return render(scene_of(parts).scene, settings_of(integrator, {set})).layers.at(0);
}

/// Pixels of which b is not a times a power of two, bit for bit.
int differing_pixels(const Film& a, const Film& b, double power_of_two = 1) {
  int count = 0;
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      PixelStatistics scaled = a.at(x, y);
      scaled.mean = scaled.mean * power_of_two;
      scaled.m2 = scaled.m2 * (power_of_two * power_of_two);
      scaled.m3 = scaled.m3 * (power_of_two * power_of_two * power_of_two);
      count += !(scaled == b.at(x, y));
    }
  return count;
}

bool is_black(const Film& film) { return film.mean() == Color<double>{0, 0, 0}; }

constexpr int all_depths = std::numeric_limits<int>::max();

/// What one layer holds.
struct Part {
  std::optional<std::int32_t> light{};
  std::optional<Technique> technique{};
  int least_depth = 0, most_depth = all_depths;
};
LayerSet only(const Part& part) {
  constexpr int depths = 4;
  LayerSet set;
  for (const Technique technique : {Technique::light, Technique::bsdf}) {
    std::vector<std::int32_t>& by_depth = set.path_part[std::size_t(technique)];
    by_depth.assign(depths, LayerSet::none);
    for (int depth = part.least_depth; depth < depths && depth <= part.most_depth; ++depth)
      if (!part.technique || *part.technique == technique) by_depth[std::size_t(depth)] = 0;
  }
  for (std::int32_t light = 0; part.light && light < light_count; ++light)
    set.light_part.push_back(light == *part.light ? 0 : LayerSet::none);
  return set;
}
LayerSet of_depths(int least, int most) { return only({{}, {}, least, most}); }
LayerSet scattered_from(std::int32_t light, Technique technique) {
  return only({light, technique, 1, all_depths});
}

LayerSet by_lights(LayerSet set = {}) {
  set.light_parts = light_count;
  for (std::int32_t light = 0; light < light_count; ++light) set.light_part.push_back(light);
  return set;
}
const LayerSet by_technique = technique_layers();
const LayerSet by_light = by_lights();
const LayerSet by_depth{.path_parts = 3, .light_part = {}, .path_part = {{{0, 1, 2}, {0, 1, 2}}}};
/// Every cell of the three together.
const LayerSet by_all = by_lights({.path_parts = 6, .light_part = {}, .path_part = {{{0, 1, 2}, {3, 4, 5}}}});

/// Samples are added up in floats, in the image and in layers in different order: each addition rounds by
/// 2^-24 of what there is. The weights of a filter have either sign, but are of one size.
void expect_sum(const Film& image, const std::vector<Film>& layers, const std::string& what) {
  constexpr double additions = 16;
  int wrong = 0;
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      Color<double> sum{0, 0, 0};
      for (const Film& film : layers) sum = sum + film.at(x, y).mean;
      const PixelStatistics& pixel = image.at(x, y);
      for (const auto channel : {&Color<double>::r, &Color<double>::g, &Color<double>::b}) {
        const double size =
            std::hypot(pixel.mean.*channel, std::sqrt(pixel.m2.*channel / double(pixel.count)));
        wrong += !(std::abs(sum.*channel - pixel.mean.*channel) <= additions * 0x1p-24 * size);
      }
    }
  EXPECT_EQ(wrong, 0) << what << ": pixels of which the layers are not the sum";
}

std::vector<float> sorted(const LargestValues& largest) {
  std::vector<float> values = largest.values();
  std::sort(values.begin(), values.end());
  return values;
}

class LayersOf : public ::testing::TestWithParam<const char*> {};

TEST_P(LayersOf, AddUpToTheImage) {
  for (const char* filter : {"box", "mitchell"}) {
    const LoadedScene loaded = scene_of({.filter = filter});
    for (const auto& [what, set] : {std::pair{"by technique", by_technique},
                                    {"by light", by_light},
                                    {"by depth", by_depth},
                                    {"by all three", by_all}}) {
      const RenderResult result = render(loaded.scene, settings_of(GetParam(), {set}));
      ASSERT_EQ(result.layers.size(), set.count());
      EXPECT_FALSE(is_black(result.film));
      expect_sum(result.film, result.layers, fmt::format("{}, {}", filter, what));
    }
  }
}

TEST_P(LayersOf, ThatTakeAllAreTheImageAndChangeNoBitOfIt) {
  const LoadedScene loaded = scene_of({.filter = "mitchell"});
  const RenderResult result = render(loaded.scene, settings_of(GetParam(), {LayerSet{}}));
  EXPECT_EQ(differing_pixels(result.film, result.layers[0]), 0);
  EXPECT_EQ(differing_pixels(result.film, image({.filter = "mitchell"}, GetParam())), 0);
}

TEST_P(LayersOf, HaveTheSameBitsForAnyNumberOfThreads) {
  const LoadedScene loaded = scene_of();
  RenderSettings settings = settings_of(GetParam(), {by_all});
  settings.noise_parts = by_all;
  settings.threads = 1;
  const RenderResult by_one = render(loaded.scene, settings);
  settings.threads = 2;
  const RenderResult by_two = render(loaded.scene, settings);
  for (std::size_t k = 0; k < by_one.layers.size(); ++k)
    EXPECT_EQ(differing_pixels(by_one.layers[k], by_two.layers[k]), 0) << k;
  for (std::size_t k = 0; k < by_one.noise.size(); ++k) {
    // The tiles are others, and sums over them round.
    EXPECT_NEAR(by_one.noise[k].variance_share, by_two.noise[k].variance_share, 1e-12) << k;
    EXPECT_EQ(sorted(by_one.noise[k].largest), sorted(by_two.noise[k].largest)) << k;
  }
}

TEST_P(LayersOf, ALightAreTheImageWhereTheOthersAreBlack) {
  if (integrator_from_name(GetParam()).light_sampler() == "tree")
    GTEST_SKIP() << "which light is chosen depends on the powers of all";
  const std::vector<Film> layers = render(scene_of().scene, settings_of(GetParam(), {by_light})).layers;
  for (std::size_t light = 0; light < light_count; ++light) {
    SceneParts alone;
    for (std::size_t other = 0; other < light_count; ++other)
      if (other != light) alone.strength[other] = 0;
    const bool is_found = light != point || settings_of(GetParam()).integrator.path_rules()->light_samples();
    EXPECT_EQ(is_black(layers[light]), !is_found) << light;
    EXPECT_EQ(differing_pixels(layers[light], image(alone, GetParam())), 0) << light;
  }
}

TEST_P(LayersOf, DepthZeroAreTheImageOfBlackSurfaces) {
  const Film black = image({.is_black = true, .has_mist = false}, GetParam());
  EXPECT_FALSE(is_black(black));
  EXPECT_EQ(differing_pixels(black, layer({.has_mist = false}, GetParam(), of_depths(0, 0))), 0);
}

INSTANTIATE_TEST_SUITE_P(Named, LayersOf,
                         ::testing::Values("path", "direct_light", "light", "direct", "average", "mis",
                                           "every_light", "whitted", "path_ems", "path_mats", "path_mis"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Layers, OfSeveralPathsFromTheFirstVertexAddUpToTheImage) {
  RenderSettings settings = settings_of("path", {by_all});
  settings.integrator = with_bsdf_samples(settings.integrator, 4);
  settings.noise_parts = by_all;
  const RenderResult result = render(scene_of().scene, settings);
  expect_sum(result.film, result.layers, "path, 4 paths");
  double share = 0;
  for (const PartNoise& part : result.noise) share += part.variance_share;
  EXPECT_NEAR(share, 1, 1e-5);
}

TEST(Layers, OfOneScatteringAreTheImageOfTheDirectIntegrator) {
  for (const auto& [paths, direct] :
       {std::pair{"path_ems", "light"}, {"path_mats", "direct"}, {"path_mis", "mis"}}) {
    EXPECT_EQ(differing_pixels(image({}, direct), layer({}, paths, of_depths(0, 1))), 0) << paths;
    EXPECT_FALSE(is_black(layer({}, paths, of_depths(2, all_depths)))) << paths;
    EXPECT_TRUE(is_black(layer({}, direct, of_depths(2, all_depths)))) << direct;
  }
}

TEST(Layers, OfATechniqueAreHalfOfWhatItFindsAlone) {
  for (const std::int32_t light : {rectangle, sphere, sky})
    for (const auto& [technique, alone] :
         {std::pair{Technique::light, "light"}, {Technique::bsdf, "direct"}}) {
      const Film both = layer({}, "average", scattered_from(light, technique));
      EXPECT_FALSE(is_black(both)) << light << ", " << alone;
      EXPECT_EQ(differing_pixels(both, layer({}, alone, only({light, {}, 1, all_depths})), 2), 0)
          << light << ", " << alone;
    }
}

TEST(Layers, OfTheCameraAndOfLightsThatNoRayMeetsAreOfOneTechnique) {
  EXPECT_TRUE(is_black(layer({}, "mis", only({{}, Technique::light, 0, 0}))));
  EXPECT_FALSE(is_black(layer({}, "mis", only({{}, Technique::bsdf, 0, 0}))));
  EXPECT_TRUE(is_black(layer({}, "path_mis", only({point, Technique::bsdf}))));
}

TEST(Layers, LeaveOutWhatTheImageLeavesOut) {
  // Samples of the sky are too strong for floats, the sky itself is not.
  SceneParts parts;
  parts.strength[sky] = 3e38;
  const LoadedScene loaded = scene_of(parts);
  for (const char* integrator : {"light", "mis", "path_ems"}) {
    const RenderResult result = render(loaded.scene, settings_of(integrator, {by_all}));
    EXPECT_GT(result.invalid.count(), 1000);
    expect_sum(result.film, result.layers, integrator);
  }
}

}  // namespace
}  // namespace etendue

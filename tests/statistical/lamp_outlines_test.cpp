// Rays of their own for the lamps that the camera sees: the image has the mean that it has without them, and
// less noise.
//
// False-alarm rate of this file: 1e-5 (Sidak over its z-tests), fixed seeds.
// Seen to fail when: what a sample's own ray meets of a lamp counts too; the mean of the rays is a sum; the
// rays leave from the middle of the lens; they lie in the pixel as a box filter has them; the back of a lamp
// shines; textures, or the medium, are passed over.
#include "integrator/integrator.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr int side_px = 24, samples = 512, replicates = 32;
constexpr double family_level = 1e-5, brightest = 40;
constexpr int images = 8;
constexpr int family_size = images * (side_px * side_px + 1);

struct Variant {
  const char* name;
  const char* integrator;
  const char* filter = "box";
  const char* lens = "";
  bool has_mist = false;

  friend void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }
};

/// Lamps that are seen whole, behind a board in part, from behind, from both sides, and with a texture.
LoadedScene scene_of(const Variant& variant) {
  std::string camera = camera_xml({0, -6, 2.5}, {0, 0, 0.9}, 40, side_px, "sobol", variant.lens);
  camera.replace(camera.find("type=\"box\""), 10, fmt::format("type=\"{}\"", variant.filter));
  const std::string twosided =
      "<luminaire type=\"area\"><color name=\"radiance\" value=\"3,5,9\"/><boolean name=\"twosided\" "
      "value=\"true\"/></luminaire>";
  const std::string textured =
      "<luminaire type=\"area\"><texture type=\"checkerboard_color\" name=\"radiance\"><color "
      "name=\"value1\" "
      "value=\"1\"/><color name=\"value2\" value=\"8,4,2\"/><point name=\"scale\" "
      "value=\"0.3,0.4\"/></texture></luminaire>";
  std::string text =
      camera + rectangle_xml({0, 0, 0}, {6, 0, 0}, {0, 6, 0}, diffuse_xml(0.5)) +
      rectangle_xml({0, 2.5, 2}, {4, 0, 0}, {0, 0, 2}, diffuse_xml(0.4)) +
      rectangle_xml({-1.2, 1, 1.5}, {0.4, 0, 0.1}, {0, 0.1, 0.3}, light_xml(12)) +
      rectangle_xml({-1.05, 0, 1.45}, {0.15, 0, 0.2}, {0, 0, 0.5}, diffuse_xml(0.3)) +  // half before it
      sphere_xml({0.1, 0.6, 1.7}, 0.3, light_xml(20)) + sphere_xml({0.7, 0, 2}, 0.05, light_xml(brightest)) +
      rectangle_xml({1.2, 0.5, 1.2}, {0.2, 0.3, 0}, {0, 0, 0.4}, light_xml(15)) +
      rectangle_xml({-1.2, 1.3, 1.5}, {0, 0, 0.5}, {0.8, 0, 0}, light_xml(9)) +  // seen from behind
      rectangle_xml({0.2, -1, 0.5}, {0.3, 0.1, 0}, {0, 0.2, 0.2}, twosided) +
      rectangle_xml({-0.8, -0.5, 0.4}, {-0.2, 0.1, 0}, {0, 0.1, 0.3}, twosided) +
      rectangle_xml({0.9, -0.4, 0.6}, {0.3, 0, 0}, {0, 0.1, 0.3}, textured);
  if (variant.has_mist)
    text +=
        "<medium type=\"homogeneous\"><color name=\"sigmaA\" value=\"0.05\"/><color name=\"sigmaS\" "
        "value=\"0.1,0.15,0.2\"/><transform name=\"toWorld\"><scale value=\"3,3,2\"/><translate "
        "value=\"-1,-1,0.1\"/></transform></medium>\n";
  return load_scene_text(text);
}

RenderResult rendered(const Scene& scene, const Variant& variant, bool has_outline_rays) {
  RenderSettings settings =
      render_settings(variant.integrator, samples, replicates, has_outline_rays ? 5 : 6, Heuristic::power);
  if (!has_outline_rays) settings.integrator.rules = settings.integrator.path_rules()->with_outline_rays(0);
  return render(scene, settings);
}

RunningStatistics green_of(const PixelStatistics& pixel) {
  return {pixel.count, pixel.mean.g, pixel.m2.g, pixel.m3.g};
}

class LampsSeen : public testing::TestWithParam<Variant> {};

TEST_P(LampsSeen, HaveTheMeanOfTheSamplesOwnRays) {
  const LoadedScene loaded = scene_of(GetParam());
  const Scene& scene = loaded.scene;
  const RenderResult with = rendered(scene, GetParam(), true), without = rendered(scene, GetParam(), false);
  EXPECT_EQ(with.invalid.count(), 0);
  EXPECT_EQ(with.counts.outline_rays, 16 * samples * scene.lamp_outlines.pixel_count());
  EXPECT_EQ(without.counts.outline_rays, 0);
  EXPECT_EQ(with.counts.camera_rays, with.counts.samples);
  double difference = 0, variance_with = 0, variance_without = 0;
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      const RunningStatistics a = green_of(with.film.at(x, y)), b = green_of(without.film.at(x, y));
      // At least one sample's worth: in a filter's tail there may be none.
      const double error = std::max(std::hypot(a.standard_error(), b.standard_error()), brightest / samples);
      EXPECT_FALSE(is_rejected(z_test(a.mean, b.mean, error).p_value, family_level, family_size))
          << x << ", " << y << ": " << a.mean << " and " << b.mean << " +- " << error
          << (scene.lamp_outlines.contains(x, y) ? ", at an outline" : "");
      if (!scene.lamp_outlines.contains(x, y)) continue;
      difference += a.mean - b.mean;
      variance_with += a.standard_error() * a.standard_error();
      variance_without += b.standard_error() * b.standard_error();
    }
  const double error = std::sqrt(variance_with + variance_without);
  EXPECT_FALSE(is_rejected(z_test(difference, 0, error).p_value, family_level, family_size))
      << difference << " +- " << error;
  EXPECT_LT(variance_with, 0.35 * variance_without);
}

TEST_P(LampsSeen, ChangeNothingElsewhere) {
  const LoadedScene loaded = scene_of(GetParam());
  RenderSettings settings = render_settings(GetParam().integrator, 16, 16, 1, Heuristic::power);
  const Film with = render(loaded.scene, settings).film;
  settings.integrator.rules = settings.integrator.path_rules()->with_outline_rays(0);
  const Film without = render(loaded.scene, settings).film;
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x)
      if (!loaded.scene.lamp_outlines.contains(x, y)) {
        EXPECT_EQ(with.at(x, y), without.at(x, y)) << x << ", " << y;
      }
}

constexpr const char* lens =
    "<float name=\"apertureRadius\" value=\"0.2\"/><float name=\"focusDistance\" value=\"3.5\"/>";

INSTANTIATE_TEST_SUITE_P(Of, LampsSeen,
                         testing::Values(Variant{"path", "path"}, Variant{"direct_light", "direct_light"},
                                         Variant{"gaussian", "direct_light", "gaussian"},
                                         Variant{"lens", "direct_light", "gaussian", lens},
                                         Variant{"mist", "path", "box", "", true},
                                         Variant{"mist_direct", "direct_light", "tent", lens, true}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(LampsSeenBy, EveryInstructionSetHaveTheSameMean) {
  const Variant variant{"direct_light", "direct_light"};
  const LoadedScene loaded = scene_of(variant);
  const Color<double> expected = rendered(loaded.scene, variant, true).film.mean();
  for (const Isa isa : available_isas()) {
    RenderSettings settings = render_settings("direct_light", samples, replicates, 5, Heuristic::power);
    settings.isa = isa;
    EXPECT_NEAR(render(loaded.scene, settings).film.mean().g, expected.g, 1e-3 * expected.g) << isa_name(isa);
  }
}

}  // namespace
}  // namespace etendue

// Renders through pixel filters: the image of an edge is the filter's own integral, negative lobes and all.
//
// False-alarm rate of this file: 1e-5 (Sidak over its t-tests), fixed seeds.
// Seen to fail when: the kernel does not weigh samples; it weighs by another sample's weight; it weighs
// before the check for invalid samples.
#include "integrator/integrator.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int rows = 48;
constexpr int family_size = 400;  // At least as many tests as are made below.

/// What is white begins at film x = 8.3; a pixel is 0.25 m.
LoadedScene edge_scene(const std::string& filter) {
  return load_scene_text(
      "<sampler type=\"independent\"/><camera type=\"perspective\"><integer name=\"width\" value=\"16\"/>"
      "<integer name=\"height\" value=\"48\"/><float name=\"fov\" value=\"43.60281897270362\"/><transform "
      "name=\"toWorld\"><scale value=\"-1,1,1\"/><lookat origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/>"
      "</transform>" +
      filter + "</camera>\n" + rectangle_xml({0.3 * 0.25 + 5, 0, 0}, {5, 0, 0}, {0, 20, 0}, light_xml(1)));
}

void expect_edge(const std::string& filter, const std::function<double(double)>& integral_from, Isa isa) {
  const LoadedScene loaded = edge_scene(filter);
  for (const int samples : {64, 2048}) {  // Many pixels a block, and more than one block a pixel.
    RenderSettings settings;
    settings.integrator = integrator_from_name("light");
    settings.samples_per_pixel = samples;
    settings.replicates = 16;
    settings.replicates_by = ReplicatesBy::scrambling;
    settings.seed = 12;
    settings.isa = isa;
    const RenderResult result = render(loaded.scene, settings);
    EXPECT_EQ(result.invalid.count(), 0);
    for (int x = 0; x < 16; ++x) {
      double mean = 0, variance = 0;  // Of a column, whose pixels are alike and independent.
      for (int y = 0; y < rows; ++y) {
        const PixelStatistics& pixel = result.film.at(x, y);
        mean += pixel.mean.g / rows;
        variance += pixel.m2.g / double(pixel.count * (pixel.count - 1)) / (rows * rows);
      }
      const double exact = integral_from(8.3 - (x + 0.5));
      // At least one sample's worth: in a filter's tail there may be none.
      const double standard_error = std::max(std::sqrt(variance), 1.0 / (rows * samples));
      EXPECT_FALSE(is_rejected(z_test(mean, exact, standard_error).p_value, family_level, family_size))
          << filter << ", " << isa_name(isa) << ", column " << x << ": " << mean << " +- " << standard_error
          << ", exact " << exact;
    }
  }
}

/// The integral of a filter of radius 2 from x on, over that of all of it.
std::function<double(double)> integral_from(const std::function<double(double)>& f) {
  return [=](double from) {
    constexpr int steps = 40000;
    double sum = 0, total = 0;
    for (int i = 0; i < steps; ++i) {
      const double x = 4 * (i + 0.5) / steps - 2;
      total += f(x);
      if (x > from) sum += f(x);
    }
    return sum / total;
  };
}

TEST(FilteredEdge, OfMitchellOvershoots) {
  const auto f = [](double x) {
    const double s = std::abs(x);
    return s < 1 ? (21 * s * s * s - 36 * s * s + 16) / 18
                 : (-7 * s * s * s + 36 * s * s - 60 * s + 32) / 18;  // B = C = 1/3
  };
  const auto exact = integral_from(f);
  ASSERT_LT(exact(1.2), -0.01);
  for (const Isa isa : available_isas()) expect_edge("<rfilter type=\"mitchell\"/>", exact, isa);
}

TEST(FilteredEdge, OfTheGaussianDoesNot) {
  const auto exact = integral_from([](double x) { return std::exp(-2 * x * x) - std::exp(-8.0); });
  for (const Isa isa : available_isas()) expect_edge("<rfilter type=\"gaussian\"/>", exact, isa);
}

}  // namespace
}  // namespace etendue

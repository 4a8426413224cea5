// Lights whose radiance is a texture: what their samples add up to, where they lie, and that hits have the
// density of the samples that find them.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the density within a cell is constant where samples follow the texture; cells that a
// triangle's long side cuts are not folded, or have the density of whole ones; the density near a facet is
// that of its texels alone; the share of a facet is left out where the whole light is sampled; u and v are
// exchanged.
#include "film_statistics.h"
#include "light/light.h"
#include "stats/chi_squared.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "test_scene.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 300;  // At least as many tests as are made below.
constexpr int samples = 20000;

/// Dim but for one texel, and black in a corner. \return four floats a texel, rows from the bottom
std::vector<float> strong_texels(int width, int height) {
  std::mt19937 random(5);
  std::vector<float> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool is_black = 2 * x >= width && 2 * y >= height;
      const float value = x == 1 && y == 2 ? 1e4f : is_black ? 0 : float(random() % 64 + 1) / 64;
      texels.insert(texels.end(), {value, value / 2, value / 4, 0});
    }
  return texels;
}

ImageTexture strong_texture(ImageTexture::Interpolation interpolation, ImageTexture::Wrap wrap) {
  ImageTexture texture;
  texture.width = 8;
  texture.height = 6;
  texture.pixels = std::make_shared<const std::vector<float>>(strong_texels(8, 6));
  texture.interpolation = interpolation;
  texture.wrap = wrap;
  return texture;
}

/// The red of the texture, in double.
double red_at(const ImageTexture& texture, double u, double v) {
  const auto wrapped = [&](double x, int size) {
    const int period = texture.wrap == ImageTexture::Wrap::mirror ? 2 * size : size;
    int i = int(std::floor(x));
    if (texture.wrap == ImageTexture::Wrap::clamp) return std::min(std::max(i, 0), size - 1);
    i = (i % period + period) % period;
    return i < size ? i : period - 1 - i;
  };
  const auto texel = [&](double x, double y) {
    const int at = wrapped(y, texture.height) * texture.width + wrapped(x, texture.width);
    return double((*texture.pixels)[std::size_t(4 * at)]);
  };
  const double x = u * texture.width, y = v * texture.height;
  if (texture.interpolation == ImageTexture::Interpolation::nearest) return texel(x, y);
  const double left = std::floor(x - 0.5), low = std::floor(y - 0.5), s = x - 0.5 - left, t = y - 0.5 - low;
  return (texel(left, low) * (1 - s) + texel(left + 1, low) * s) * (1 - t) +
         (texel(left, low + 1) * (1 - s) + texel(left + 1, low + 1) * s) * t;
}

struct TexturedCase {
  std::string name;
  Mesh mesh;
  ImageTexture texture;
  Geometry geometry = {};
  Lights lights = {};

  void shine() {
    const std::int32_t id = geometry.add_mesh(mesh, {0, 0});
    lights.add<TexturedLights>({1, 1, 1}, name, geometry, id, texture);
  }
  Vec3d corner(std::size_t triangle, int k) const {
    return widen(mesh.positions[mesh.indices[3 * triangle + std::size_t(k)]]);
  }
  Vec2<double> uv(std::size_t triangle, double a, double b) const {
    const auto at = [&](int k) { return mesh.uvs[mesh.indices[3 * triangle + std::size_t(k)]]; };
    const double w = 1 - a - b;
    return {at(0).x * w + at(1).x * a + at(2).x * b, at(0).y * w + at(1).y * a + at(2).y * b};
  }
  double area(std::size_t t) const {
    return 0.5 * length(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
  }
};

/// A quadrangle whose front looks down.
TexturedCase case_of(const std::string& name, const std::array<Vec3f, 4>& places,
                     const std::array<Vec2f, 4>& uvs, const ImageTexture& texture) {
  TexturedCase c{name, {}, texture};
  c.mesh.positions.assign(places.begin(), places.end());
  c.mesh.uvs.assign(uvs.begin(), uvs.end());
  c.mesh.indices = {0, 1, 2, 0, 2, 3};
  c.shine();
  return c;
}

std::vector<TexturedCase> cases() {
  using Wrap = ImageTexture::Wrap;
  using Interpolation = ImageTexture::Interpolation;
  const std::array<Vec3f, 4> rectangle{Vec3f{-1, -0.6f, 2}, {-1, 0.9f, 2}, {1, 0.9f, 2}, {1, -0.6f, 2}},
      ragged{Vec3f{-1, -0.6f, 2}, {-1.2f, 0.9f, 2.2f}, {1, 0.7f, 2.4f}, {0.8f, -0.6f, 2}};
  const std::array<Vec2f, 4> whole{Vec2f{0, 0}, {0, 1}, {1, 1}, {1, 0}},
      across{Vec2f{-0.3f, 0.1f}, {1.5f, 0.1f}, {1.5f, 0.8f}, {-0.3f, 0.8f}},
      askew{Vec2f{0.1f, 0}, {0, 1}, {0.9f, 0.8f}, {1, 0.2f}};
  std::vector<TexturedCase> all;
  all.push_back(case_of("bilinear", rectangle, whole, strong_texture(Interpolation::bilinear, Wrap::repeat)));
  all.push_back(case_of("nearest", rectangle, whole, strong_texture(Interpolation::nearest, Wrap::clamp)));
  all.push_back(case_of("across", rectangle, across, strong_texture(Interpolation::bilinear, Wrap::mirror)));
  all.push_back(case_of("askew", ragged, askew, strong_texture(Interpolation::bilinear, Wrap::clamp)));
  all.push_back(all.back());
  ImageTexture mild = all.back().texture;
  std::vector<float> texels = *mild.pixels;
  for (float& value : texels) value = std::min(value, 1.0f);
  mild.pixels = std::make_shared<const std::vector<float>>(std::move(texels));
  all.back().name = "one triangle, mild";
  all.back().texture = mild;
  all.back().mesh.indices.resize(3);
  all.back().geometry = {};
  all.back().lights = {};
  all.back().shine();
  return all;
}

struct Case {
  const char* name;
  Receiver<float> receiver;
};
std::vector<Case> receivers() {
  constexpr std::int32_t front = lit_side::front;
  const Vec3f up{0, 0, 1}, tilted = normalize(Vec3f{0.7f, 0.2f, 0.5f});
  return {{"far", {{0.4f, 3, -20}, up, up, front}},
          {"below", {{0.3f, 0.2f, 0.5f}, tilted, tilted, front}},
          {"near", {{-0.5f, 0.1f, 1.8f}, up, up, front}}};
}

/// f(triangle, place, uv, area) for the middles of n^2 parts of each triangle.
template <class Function>
void for_each_part(const TexturedCase& c, std::size_t triangle, int n, Function&& f) {
  const Vec3d at = c.corner(triangle, 0), side_1 = c.corner(triangle, 1) - at,
              side_2 = c.corner(triangle, 2) - at;
  const double area = c.area(triangle) / (double(n) * n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j < n; ++i)
      for (const bool is_upper : {false, true}) {
        if (is_upper && i + j == n - 1) continue;
        const double a = (i + (is_upper ? 2.0 : 1.0) / 3) / n, b = (j + (is_upper ? 2.0 : 1.0) / 3) / n;
        f(at + side_1 * a + side_2 * b, c.uv(triangle, a, b), area);
      }
}

/// Of the radiance in red, in double.
double irradiance(const TexturedCase& c, const Receiver<float>& receiver) {
  double sum = 0;
  for (std::size_t triangle = 0; triangle < c.mesh.triangle_count(); ++triangle) {
    const Vec3d ng = normalize(
        cross(c.corner(triangle, 1) - c.corner(triangle, 0), c.corner(triangle, 2) - c.corner(triangle, 0)));
    for_each_part(c, triangle, 960, [&](const Vec3d& place, const Vec2<double>& uv, double area) {
      const Vec3d to_light = place - widen(receiver.position);
      const double distance_sq = length_sq(to_light);
      const double cosines =
          std::max(dot(to_light, widen(receiver.ns)), 0.0) * std::max(-dot(to_light, ng), 0.0);
      sum += red_at(c.texture, uv.x, uv.y) * cosines / (distance_sq * distance_sq) * area;
    });
  }
  return sum;
}

/// Of the triangle that holds a place, with the receiver's direction.
LightHit<float> hit_at(const TexturedCase& c, std::size_t triangle, const Vec3f& place,
                       const Receiver<float>& receiver, bool is_facet_chosen, LightTechnique technique) {
  const Vec3d ng = normalize(
      cross(c.corner(triangle, 1) - c.corner(triangle, 0), c.corner(triangle, 2) - c.corner(triangle, 0)));
  return {place,
          {float(ng.x), float(ng.y), float(ng.z)},
          normalize(place - receiver.position),
          c.lights.facet_at<float>(0, std::int32_t(triangle), place, true),
          is_facet_chosen,
          technique};
}

std::size_t triangle_of(const TexturedCase& c, const Vec3f& place) {
  if (c.mesh.triangle_count() == 1) return 0;
  // Above or below the diagonal that both share.
  const Vec3d diagonal = c.corner(0, 2) - c.corner(0, 0), way = widen(place) - c.corner(0, 0),
              side = c.corner(0, 1) - c.corner(0, 0);
  return dot(cross(diagonal, way), cross(diagonal, side)) > 0 ? 0 : 1;
}

/// By facets as the light tree chooses them.
struct FacetChoice {
  std::int32_t facet;
  float pmf;
};
FacetChoice choose_facet(const Lights& lights, double u) {
  std::int32_t facet = 0;
  const auto pmf = [&](std::int32_t k) { return lights.facet_power(0, k) / lights.power(0); };
  while (facet + 1 < lights.facet_count(0) && u >= pmf(facet)) u -= pmf(facet++);
  return {facet, float(pmf(facet))};
}

constexpr std::array techniques{LightTechnique::area, LightTechnique::solid_angle,
                                LightTechnique::projected_solid_angle, LightTechnique::automatic};

TEST(TexturedLights, SendWhatQuadratureSaysByEveryTechnique) {
  for (const TexturedCase& c : cases())
    for (const Case& at : receivers()) {
      const double exact = irradiance(c, at.receiver);
      ASSERT_GT(exact, 0);
      for (const LightTechnique technique : techniques)
        for (const bool is_by_facet : {false, true}) {
          std::mt19937 random(3);
          std::uniform_real_distribution<double> uniform;
          RunningStatistics statistics;
          int other = 0, compared = 0;
          for (int i = 0; i < samples; ++i) {
            const FacetChoice chosen =
                is_by_facet ? choose_facet(c.lights, uniform(random)) : FacetChoice{whole_light, 1};
            const std::uint32_t u_x = random(), u_y = random();
            const LightSample<float> sample =
                c.lights.sample<float>(0, chosen.pmf, at.receiver, {u_x, u_y}, true, chosen.facet, technique);
            statistics.add(sample.is_there ? std::max(0.0f, dot(sample.wi, at.receiver.ns)) *
                                                 double(sample.radiance_over_pdf.r)
                                           : 0);
            if (!sample.is_there || i % 8 != 0) continue;
            const LightHit<float> hit =
                hit_at(c, triangle_of(c, sample.end), sample.end, at.receiver, is_by_facet, technique);
            float pmf = 1;
            if (is_by_facet) pmf = float(c.lights.facet_power(0, hit.facet) / c.lights.power(0));
            const float found = c.lights.pdf_solid_angle<float>(0, pmf, at.receiver, hit, true);
            ++compared;
            other += !(std::abs(found / sample.pdf_solid_angle - 1) < 2e-3);
          }
          const std::string what = c.name + ", " + at.name + ", " +
                                   std::string(light_technique_name(technique)) +
                                   (is_by_facet ? ", by facet" : "");
          const MeanTest test = t_test(statistics, exact, exact * exact * 1e-9);
          EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
              << what << ": " << statistics.mean << " +- " << statistics.standard_error() << ", exact "
              << exact;
          // Rounding puts a place at the edge of a cell into the next.
          EXPECT_LE(other, compared / 200 + 1) << what << ": of " << compared;
          if (technique == LightTechnique::automatic && std::string_view(at.name) == "far") {
            EXPECT_LT(statistics.variance(),
                      (c.mesh.triangle_count() == 1 || c.name == "askew" ? 1 : 2e-3) * exact * exact)
                << what;
          }
        }
    }
}

TEST(TexturedLights, HaveTheDensityOfTheirSamples) {
  constexpr int cells_a_side = 6, parts = 80, drawn = 40000;
  for (const TexturedCase& c : cases())
    for (const Case& at : receivers()) {
      const auto cell_of = [&](std::size_t triangle, const Vec3d& place) {
        const Vec3d from = place - c.corner(triangle, 0),
                    side_1 = c.corner(triangle, 1) - c.corner(triangle, 0),
                    side_2 = c.corner(triangle, 2) - c.corner(triangle, 0), across = cross(side_1, side_2);
        const double a = dot(cross(from, side_2), across) / length_sq(across),
                     b = dot(cross(side_1, from), across) / length_sq(across);
        const auto whole = [](double x) {
          return std::min(std::max(int(x * cells_a_side), 0), cells_a_side - 1);
        };
        return (std::size_t(triangle) * cells_a_side + std::size_t(whole(a))) * cells_a_side +
               std::size_t(whole(b));
      };
      std::vector<double> expected(c.mesh.triangle_count() * cells_a_side * cells_a_side, 0),
          observed = expected;
      double lost = 0;
      for (std::size_t triangle = 0; triangle < c.mesh.triangle_count(); ++triangle)
        for_each_part(c, triangle, cells_a_side * parts,
                      [&](const Vec3d& place, const Vec2<double>&, double area) {
                        const Vec3f p{float(place.x), float(place.y), float(place.z)};
                        const LightHit<float> hit =
                            hit_at(c, triangle, p, at.receiver, false, LightTechnique::automatic);
                        const double pdf = c.lights.pdf_solid_angle<float>(0, 1, at.receiver, hit, true);
                        const double distance_sq = length_sq(place - widen(at.receiver.position));
                        expected[cell_of(triangle, place)] +=
                            pdf * std::max(-double(dot(hit.ng, hit.wi)), 0.0) / distance_sq * area * drawn;
                      });
      std::mt19937 random(9);
      for (int i = 0; i < drawn; ++i) {
        const std::uint32_t u_x = random(), u_y = random();
        const LightSample<float> sample = c.lights.sample<float>(0, 1, at.receiver, {u_x, u_y}, true,
                                                                 whole_light, LightTechnique::automatic);
        if (!sample.is_there)
          ++lost;
        else
          ++observed[cell_of(triangle_of(c, sample.end), widen(sample.end))];
      }
      double sum = 0;
      for (const double n : expected) sum += n;
      EXPECT_NEAR(sum / drawn, 1, 4e-3) << c.name << ", " << at.name;
      EXPECT_EQ(lost, 0) << c.name << ", " << at.name;
      const ChiSquaredTest test = chi_squared_test(observed, expected, {5, 5});
      EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
          << c.name << ", " << at.name << ": " << test.statistic << " of " << test.degrees_of_freedom;
    }
}

/// However dim it is beside what is bright.
TEST(TexturedLights, MayBeSampledWhereverTheyShine) {
  for (TexturedCase c : cases()) {
    std::vector<float> texels = *c.texture.pixels;
    for (std::size_t i = 0; i < texels.size(); ++i)
      if (texels[i] > 0 && texels[i] < 10) texels[i] *= 1e-12f;
    c.texture.pixels = std::make_shared<const std::vector<float>>(std::move(texels));
    Lights lights;
    lights.add<TexturedLights>({1, 1, 1}, c.name, c.geometry, 0, c.texture);
    const Receiver<float> far = receivers().front().receiver;
    int dark = 0;
    for (std::size_t triangle = 0; triangle < c.mesh.triangle_count(); ++triangle)
      for_each_part(c, triangle, 97, [&](const Vec3d& place, const Vec2<double>& uv, double) {
        const Vec3f p{float(place.x), float(place.y), float(place.z)};
        LightHit<float> hit = hit_at(c, triangle, p, far, true, LightTechnique::automatic);
        hit.facet = lights.facet_at<float>(0, std::int32_t(triangle), p, true);
        const bool is_bright = red_at(c.texture, uv.x, uv.y) > 0;
        dark += !is_bright;
        if (!is_bright) return;
        EXPECT_GT(lights.pdf_solid_angle<float>(0, 1, far, hit, true), 0) << c.name;
        EXPECT_GT(lights.facet_power(0, hit.facet), 0) << c.name;
      });
    EXPECT_GT(dark, 100) << c.name;
  }
}

/// The same texels as a Radiance HDR file: a byte a channel and an exponent, without runs.
SceneFile hdr_file(const std::string& name, int width, int height, const std::vector<float>& texels) {
  std::string text = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width);
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x) {
      const float* rgb = &texels[std::size_t(4 * (y * width + x))];
      int exponent = 0;
      std::frexp(rgb[0], &exponent);
      for (int k = 0; k < 3; ++k) text += char(std::lround(std::ldexp(rgb[k], 8 - exponent)));
      text += char(rgb[0] > 0 ? exponent + 128 : 0);
    }
  return {name, text};
}

/// A floor below, by light samples, by rays that meet the light, and by both.
TEST(TexturedLights, LightAFloorAsQuadratureSays) {
  using Interpolation = ImageTexture::Interpolation;
  ImageTexture texture = strong_texture(Interpolation::bilinear, ImageTexture::Wrap::repeat);
  std::vector<float> texels = *texture.pixels;
  for (float& value : texels) value = value > 10 ? 32 : std::floor(value * 16) / 16;  // A byte holds them.
  texture.pixels = std::make_shared<const std::vector<float>>(texels);
  const auto light = [&](double scale) {
    return fmt::format(
        "<luminaire type=\"area\"><texture type=\"imagetexture\" name=\"radiance\"><string name=\"filename\" "
        "value=\"texels.hdr\"/></texture><float name=\"scale\" value=\"{}\"/></luminaire>",
        scale);
  };
  constexpr double albedo = 0.6, scale = 1.5;
  const Vec3d center{0.1, 0.2, 1}, half_u{0.8, 0, 0}, half_v{0, -0.7, 0};
  TexturedCase same =
      case_of("rectangle", {Vec3f{-0.7f, 0.9f, 1}, {0.9f, 0.9f, 1}, {0.9f, -0.5f, 1}, {-0.7f, -0.5f, 1}},
              {Vec2f{0, 0}, {1, 0}, {1, 1}, {0, 1}}, texture);
  const double exact = scale * albedo / std::numbers::pi *
                       irradiance(same, {{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, lit_side::front});
  const LoadedScene loaded =
      load_scene_text(camera_xml({1.5, -2.5, 2}, {0, 0, 0}, 0.001, 32, "sobol") +
                          rectangle_xml({0, 0, 0}, {50, 0, 0}, {0, 50, 0}, diffuse_xml(albedo)) +
                          rectangle_xml(center, half_u, half_v, light(scale)),
                      {hdr_file("texels.hdr", 8, 6, texels)});
  for (const char* integrator : {"direct_light", "light", "direct", "mis"}) {
    const RenderResult result =
        render(loaded.scene, render_settings(integrator, 256, 4, 7, Heuristic::balance));
    EXPECT_EQ(result.invalid.count(), 0);
    const RunningStatistics radiance = statistics_of_pixels(result.film, &Color<double>::r);
    const MeanTest test = t_test(radiance, exact, exact * exact * 1e-10);
    EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
        << integrator << ": " << radiance.mean << " +- " << radiance.standard_error() << ", exact " << exact;
    EXPECT_LT(radiance.standard_error() / exact, 1e-2) << integrator << ": too few samples";
  }
}

TEST(TexturedLights, AreParallelogramsWhereTheirTexturesAre) {
  const std::vector<TexturedCase> all = cases();
  EXPECT_EQ(textured_patches(all[0].geometry, 0).patches.size(), 1u);
  EXPECT_EQ(textured_patches(all[2].geometry, 0).patches.size(), 1u);
  EXPECT_EQ(textured_patches(all[3].geometry, 0).patches.size(), 2u);
  TexturedCase other = all[0];
  other.mesh.uvs[3] = {0.9f, 0.1f};
  const std::int32_t id = other.geometry.add_mesh(other.mesh, {0, 0});
  EXPECT_EQ(textured_patches(other.geometry, id).patches.size(), 2u);
}

}  // namespace
}  // namespace etendue

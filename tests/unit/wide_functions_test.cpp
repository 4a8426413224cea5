// Every function of the wide code gives, at every instruction set of this machine, what it gives for one
// lane.
//
// Seen to fail when: less compares as signed; mul_hi leaves out a carry; 0^0 is 1 in the batches; select
// swaps its arguments for integers; sincos_turns is off by 1e-6; the angles of a polygon's first side count
// where a neighbour is cut by the horizon.
#include "wide/wide_functions.h"

#include "image/image_file.h"
#include "render/isa.h"
#include "test_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <dlfcn.h>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <string>

namespace etendue {
namespace {

WideFunctions load(Isa isa) {
  const std::string file =
      fmt::format(ETENDUE_BINARY_DIR "/lib/libetendue_wide_functions_{}.so", isa_name(isa));
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) throw std::runtime_error(dlerror());
  return reinterpret_cast<WideFunctions (*)()>(dlsym(module, "etendue_wide_functions"))();
}

/// Makes one input column's next value, often one from the edges of its range.
using Source = std::function<std::uint32_t(std::mt19937&)>;

std::uint32_t bits(float v) { return std::bit_cast<std::uint32_t>(v); }

Source any_word() {
  return [](std::mt19937& random) {
    constexpr std::uint32_t edges[]{0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0xffff, 0x10000};
    return random() % 8 == 0 ? edges[random() % std::size(edges)] : std::uint32_t(random());
  };
}
Source word_below(std::uint32_t n) {
  return [=](std::mt19937& random) { return std::uint32_t(random() % n); };
}
Source real(float low, float high, std::vector<float> edges = {}) {
  return [=](std::mt19937& random) {
    if (!edges.empty() && random() % 8 == 0) return bits(edges[random() % edges.size()]);
    return bits(std::uniform_real_distribution<float>(low, high)(random));
  };
}
Source unit() { return real(0, 1, {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 0x1.fffffep-1f}); }
/// 10^low .. 10^high
Source magnitude(float low, float high, std::vector<float> edges = {}) {
  return [=, uniform = real(low, high)](std::mt19937& random) {
    if (!edges.empty() && random() % 8 == 0) return bits(edges[random() % edges.size()]);
    return bits(std::pow(10.0f, std::bit_cast<float>(uniform(random))));
  };
}

/// Bounds for |wide - scalar|: `ulps` of the larger of |scalar| and `scale`.
struct Case {
  std::vector<Source> inputs;  ///< The last one repeats; `directions` come first.
  double ulps = 0;
  double scale = std::numeric_limits<float>::min();
  int directions = 0;  ///< The first so many triples of inputs are unit vectors.
};

/// Where a bound is not a few ulps, the reason is given. FMA instructions, which v3 and v4 have, round once
/// where the scalar code rounds twice: sums of products of size 1 then differ by an ulp or two of 1.
std::map<std::string, Case> cases(std::uint32_t lights) {
  const Source exponent = magnitude(0, 4, {0, 1, 10000});
  std::map<std::string, Case> all;
  all["sample_2d independent"] = all["sample_2d sobol"] = {{any_word()}};
  all["mul_hi"] = all["less"] = all["hash32"] = all["to_unit_float"] = {{any_word()}};
  all["to_int"] = {{real(-1e6f, 1e6f, {0, -0.5f, 0.999f, -1e6f})}};
  all["exp"] = {{real(-80, 80, {0, 1, -1})}, 3};
  // Near 1 the logarithm goes to 0, and its error counts against the argument's.
  all["log"] = {{magnitude(-30, 30, {1, 0x1.fffffep-1f})}, 3, 0.01};
  // exp(y log x): the error of log x grows by y log x, which is 75 where the result is 1e-33. Far smaller
  // ones become 0, not denormal.
  all["pow_positive"] = {{real(0, 1, {0, 1, 0x1.fffffep-1f}), exponent}, 100, 1e-33};
  all["sincos_turns"] = {{unit()}, 4, 1};
  all["atan2"] = {{real(-4, 4, {0, 1, -1})}, 4, 1};
  all["square_to_triangle"] = {{unit()}, 1};
  all["square_to_cosine_hemisphere"] = {{unit()}, 5, 1};
  all["cosine_hemisphere_pdf"] = {{real(-1, 1, {0, 1})}, 1};
  // cos^2 close to 1 leaves sin few digits: an ulp of the cosine is 3e-4 of the sine where that is 3e-4 too.
  all["square_to_power_cosine"] = {{unit(), unit(), exponent}, 4000, 1};
  all["power_cosine_pdf"] = {{real(-1, 1, {0, 1, 0x1.fffffep-1f}), exponent}, 100, 1e-30};
  all["square_to_uniform_cone"] = {{unit(), unit(), magnitude(-6, 0, {1})}, 6, 1};
  all["uniform_cone_pdf"] = {{magnitude(-6, 0, {1})}, 1};
  all["square_to_uniform_disk"] = {{unit()}, 4, 1};
  // sqrt(1 - z^2) near a pole.
  all["square_to_uniform_sphere"] = {{unit()}, 12, 1};
  all["sphere_uv"] = {{real(0, 0.9f, {0, 0.5f})}, 4, 1, 1};
  all["disk_uv"] = {{real(-1, 1, {0, 1, -1})}, 4, 1};
  all["Frame"] = {{real(-1, 1)}, 4, 1, 2};
  all["sample_offset_px"] = {{unit()}, 3, 1};
  // The sign at the edge of a lobe is exact: it compares the numbers themselves.
  all["sample_offset_px, sample_weight"] = {{unit()}, 3, 1};
  // Of film coordinates up to 64 px, and of the clip plane at 1e4 m.
  all["Camera::ray"] = {{real(0, 64, {0, 64})}, 4, 1};
  all["Camera::ray, lens"] = {{real(0, 64, {0, 64}), real(0, 64), real(-1, 1, {0, 1})}, 4, 1};
  all["interpolate_normal"] = {{word_below(1), word_below(8), real(0, 0.5f, {0})}, 4, 1};
  all["Diffuse::eval"] = all["Diffuse::pdf_solid_angle"] = {{real(-1, 1)}, 1, 1e-30, 2};
  all["Diffuse::sample"] = {{unit()}, 5, 1, 1};
  // n = 30: an ulp of cos alpha is 30 of the lobe; times its height, (n + 2) / (2 pi).
  all["Phong::eval"] = all["Phong::pdf_solid_angle"] = {{real(-1, 1)}, 20, 5, 2};
  // As square_to_power_cosine, for n = 30, then turned.
  all["Phong::sample"] = {{unit()}, 40, 1, 1};
  // Lobes of roughness 0.3, some 3 high. A sample has the square root of what is left of 1 - cos^2, as
  // square_to_power_cosine.
  for (const std::string name : {"Microfacet", "RoughConductor ggx", "RoughConductor beckmann",
                                 "RoughDielectric ggx", "RoughDielectric beckmann"}) {
    all[name + "::eval"] = all[name + "::pdf_solid_angle"] = {{real(-1, 1)}, 40, 5, 2};
    // Slopes of Beckmann's have no end: towards 1 the rounding of the random number itself decides.
    const bool is_endless = name.ends_with("beckmann");
    all[name + "::sample"] = {
        {is_endless ? real(0, 1, {0, 0.25f, 0.5f, 0.75f, 0.999f}) : unit()}, 4000, 1, 1};
  }
  all["Dielectric::sample"] = {{unit()}, 10, 1, 1};
  // Not at the edges of squares, where rounding decides.
  all["textures"] = {{real(-3, 3)}, 200, 1};
  all["inverse_erf"] = {{real(-1, 1, {0, 0x1.fffffep-1f})}, 8};
  all["split_unit"] = {{unit()}};
  // Coordinates of a few metres; normals are sums of products. A sphere's normal has the square root of what
  // is left of 1 - cos^2.
  all["Lights::sample end"] = {
      {word_below(lights), real(-4, 4), real(-4, 4), real(0, 1.2f), any_word()}, 60, 1};
  // The cosine at the edge of a sphere is a difference of nearly equal numbers.
  all["Lights::pdf_solid_angle"] = {
      {word_below(lights), real(-4, 4), real(-4, 4), real(0, 1.2f), any_word()}, 30, 1};
  all["SphericalPolygon"] = {{word_below(2), real(-4, 4), real(-4, 4), real(0, 1.2f), unit()}, 30, 1};
  // Shares of a measure that is added up from angles up to 4096 times larger; where a sector begins it holds
  // so little that their rounding moves the azimuth far.
  all["ProjectedPolygon"] = {{word_below(2), real(-4, 4), real(-4, 4), real(0, 1.2f), real(0, 1)}, 400000, 1};
  // Rounding decides at the bound: only that neighbours do not is tested.
  all["ProjectedPolygon::is_accurate"] = {
      {word_below(2), real(-4, 4), real(-4, 4), real(1.9f, 2)}, 1e9, 1, 1};
  // The square root at the edge of the disk.
  all["SphericalEllipse"] = {
      {real(-4, 4), real(-4, 4), magnitude(-2, 1), magnitude(-4, 0, {1}), unit()}, 2000, 1};
  // As square_to_uniform_disk, and the height of what is 1e-3 high at least.
  all["ProjectedCap"] = {{magnitude(-6, 0, {0.25f}), unit()}, 10000, 1, 2};
  // A receiver near a light's plane: the cosine, hundreds of times smaller than the products it is summed
  // from, divides. No edges: at a sphere's very rim rounding decides whether it is seen.
  all["sample of a uniform light"] = all["sample of a light by power"] = {
      {real(-4, 4), real(-4, 4), real(0, 1.2f), [](std::mt19937& random) { return std::uint32_t(random()); }},
      4000,
      10};
  // The sine from the square root of what is left of 1 - cos^2, as square_to_power_cosine.
  all["importance of lights"] = {
      {real(-4, 4), real(-4, 4), real(-4, 4), magnitude(-3, 0), real(-1, 1, {-1, 1})}, 4000, 1, 2};
  // Up to four lights of radiance 3; a texel of the map is an ulp of the angle times its width wide.
  all["environment"] = {{}, 200, 3, 1};
  all["mis_weight balance"] = all["mis_weight power"] = {{magnitude(-6, 6), magnitude(-6, 6, {0})}, 4};
  return all;
}

/// Six lights that are no surfaces, two of each of the sorts: points, directions, all around.
const std::string other_lights =
    R"(<luminaire type="point"><point name="position" value="1,-2,3"/></luminaire>
    <luminaire type="spot"><float name="cutoffAngle" value="70"/><transform name="toWorld">
      <lookat origin="-1,2,4" target="0,0,0" up="0,1,0"/></transform></luminaire>
    <luminaire type="directional"><vector name="direction" value="1,2,-3"/></luminaire>
    <luminaire type="constant"/>
    <luminaire type="distantdisk"><float name="thetaA" value="33"/><transform name="toWorld">
      <rotate axis="1,2,3" angle="50"/></transform></luminaire>
    <luminaire type="envmap"><string name="filename" value="map.exr"/><transform name="toWorld">
      <rotate axis="1,0,2" angle="40"/></transform></luminaire>)";

/// A smooth map with a dark side.
SceneFile map_file() {
  constexpr int width = 37, height = 20;
  Image image{width, height, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        image.channels[k].values.push_back(
            std::max(0.0f, std::sin(0.17f * float(i)) + 0.5f * std::cos(0.3f * float(j) + float(k))));
  const test::TemporaryFolder folder;
  write_exr(folder.path() / "map.exr", image);
  std::ifstream stream(folder.path() / "map.exr", std::ios::binary);
  return {"map.exr", {std::istreambuf_iterator<char>(stream), {}}};
}

std::string bsdf_xml(const std::string& type, const std::string& inside) {
  return fmt::format("<bsdf type=\"{}\"><float name=\"alpha\" value=\"0.3\"/>{}</bsdf>", type, inside);
}
std::string textured_xml(const std::string& texture) {
  return fmt::format("<bsdf type=\"diffuse\">{}</bsdf>", texture);
}

/// At least 3 area lights of all kinds and, with more than 8, also other_lights; materials 0 diffuse, 1
/// glossy, 2 a light's, then all others in the order of the table, then three textures; geometry 0 is smooth.
LoadedScene test_scene(std::uint32_t lights) {
  constexpr std::uint32_t few = 8, others = 6;
  const test::TemporaryFolder folder;
  const std::filesystem::path image = folder.path() / "texture.exr";
  write_exr(image,
            {2, 2, {{"R", {0.1f, 0.9f, 0.4f, 0.7f}}, {"G", {1, 0, 0, 1}}, {"B", {0, 0.2f, 0.6f, 1}}}, {}});
  const std::string ggx = "<string name=\"distribution\" value=\"ggx\"/>";
  std::string more = lights > few ? other_lights : "";
  for (const std::string& bsdf :
       {bsdf_xml("microfacet", ""), bsdf_xml("roughconductor", ggx), bsdf_xml("roughconductor", ""),
        bsdf_xml("roughdielectric", ggx), bsdf_xml("roughdielectric", ""),
        std::string("<bsdf type=\"dielectric\"/>"),
        textured_xml("<texture type=\"checkerboard_color\" name=\"albedo\"/>"),
        textured_xml("<texture type=\"uvtexture\" name=\"albedo\"/>"),
        textured_xml("<texture type=\"imagetexture\" name=\"albedo\"><string name=\"filename\" "
                     "value=\"" +
                     image.string() + "\"/></texture>")})
    more += sphere_xml({9, 9, 9}, 0.1, bsdf);
  for (std::uint32_t i = 3 + (lights > few ? others : 0); i < lights; ++i)
    more += rectangle_xml({0.3 * i, 0.1 * i, 3 + 0.1 * i}, {0.5, 0, 0}, {0, -0.5, 0.1}, light_xml(1 + i));

  const std::string lens =
      "<float name=\"apertureRadius\" value=\"0.2\"/><float name=\"focusDistance\" value=\"3\"/>";
  const std::string octahedron =
      "v 1 0 2\nv -1 0 2\nv 0 1 2\nv 0 -1 2\nv 0 0 3\nv 0 0 1.4\nvn 1 0 0\nvn -1 0 0\nvn 0 1 0\nvn 0 -1 "
      "0\nvn 0 0 1\nvn 0 0 -1\n"
      "f 1//1 3//3 5//5\nf 3//3 2//2 5//5\nf 2//2 4//4 5//5\nf 4//4 1//1 5//5\n"
      "f 3//3 1//1 6//6\nf 2//2 3//3 6//6\nf 4//4 2//2 6//6\nf 1//1 4//4 6//6\n";
  return load_scene_text(
      camera_xml({1, 2, 3}, {0, 0, 0}, 50, 64, "sobol", lens) +
          mesh_xml("octahedron.obj", diffuse_xml(0.6) + light_xml(3)) +
          rectangle_xml({0, 0, 4}, {1, 0.2, 0}, {0, -1, 0.3}, phong_xml(0.3, 0.5, 30) + light_xml(2)) +
          sphere_xml({2, 1, 3}, 0.6, light_xml(5)) + more,
      {{"octahedron.obj", octahedron}, map_file()});
}

constexpr int count = 1 << 14;
struct alignas(64) Column {
  std::uint32_t words[count];
};

std::vector<Column> make_inputs(const Case& c, int columns) {
  std::mt19937 random(17);
  std::vector<Column> in(static_cast<std::size_t>(columns));
  std::normal_distribution<float> normal;
  for (int i = 0; i < count; ++i) {
    for (int k = 3 * c.directions; k < columns; ++k)
      in[std::size_t(k)].words[i] =
          c.inputs[std::min(std::size_t(k - 3 * c.directions), c.inputs.size() - 1)](random);
    for (int d = 0; d < c.directions; ++d) {
      Vec3f v = normalize(Vec3f{normal(random), normal(random), normal(random)});
      const Vec3f edges[]{{0, 0, 1},  {0, 0, -1},          {1, 0, 0},
                          {0, -1, 0}, {0.6f, 0.8f, -0.0f}, {0, 0.8f, -0.6f}};
      if (i % 16 == 0) v = edges[random() % std::size(edges)];
      const float xyz[]{v.x, v.y, v.z};
      for (int k = 0; k < 3; ++k) in[std::size_t(3 * d + k)].words[i] = bits(xyz[k]);
    }
  }
  return in;
}

std::vector<Column> run(const WideFunction& function, const Scene& scene, const std::vector<Column>& in) {
  std::vector<Column> out(static_cast<std::size_t>(function.outputs));
  std::vector<const std::uint32_t*> from;
  std::vector<std::uint32_t*> to;
  for (const Column& column : in) from.push_back(column.words);
  for (Column& column : out) to.push_back(column.words);
  function.run(scene, from.data(), to.data(), count);
  return out;
}

void expect_equal_functions(Isa isa, std::uint32_t lights) {
  const LoadedScene loaded = test_scene(lights);
  ASSERT_EQ(loaded.scene.lights.count(), std::int32_t(lights));
  const WideFunctions scalar = load(Isa::scalar), wide = load(isa);
  ASSERT_EQ(scalar.count, wide.count);
  const std::map<std::string, Case> all = cases(lights);
  for (std::size_t f = 0; f < wide.count; ++f) {
    const WideFunction& function = wide.functions[f];
    ASSERT_TRUE(all.contains(function.name)) << function.name << " has no case";
    const Case& c = all.at(function.name);
    const std::vector<Column> in = make_inputs(c, function.inputs);
    const std::vector<Column> expected = run(scalar.functions[f], loaded.scene, in),
                              found = run(function, loaded.scene, in);
    double worst = 0;
    int shown = 0;
    for (std::size_t k = 0; k < found.size(); ++k)
      for (int i = 0; i < count; ++i) {
        const std::uint32_t a = expected[k].words[i], b = found[k].words[i];
        if (a == b) continue;
        double ulps = std::numeric_limits<double>::infinity();
        if (function.output_words == Words::floats) {
          const double x = std::bit_cast<float>(a), y = std::bit_cast<float>(b);
          if (std::isnan(x) && std::isnan(y)) continue;
          ulps = std::abs(x - y) / (std::max(std::abs(x), c.scale) * 0x1p-23);
        }
        worst = std::isnan(ulps) ? std::numeric_limits<double>::infinity() : std::max(worst, ulps);
        if (!(ulps <= c.ulps) && ++shown <= 3) {
          std::string inputs;
          for (const Column& column : in)
            inputs += fmt::format(" {:#x} ({})", column.words[i], std::bit_cast<float>(column.words[i]));
          ADD_FAILURE() << isa_name(isa) << ", " << function.name << ", output " << k << ": "
                        << std::bit_cast<float>(b) << ", scalar " << std::bit_cast<float>(a) << ", " << ulps
                        << " ulps, of" << inputs;
        }
      }
    ::testing::Test::RecordProperty(fmt::format("{}, {} lights", function.name, lights),
                                    fmt::format("{:.3g} of {} ulps", worst, c.ulps));
  }
}

/// What a lane gives does not depend on its neighbours: samples may fall into packets in any way.
void expect_independent_lanes(Isa isa) {
  const LoadedScene loaded = test_scene(3);
  const WideFunctions wide = load(isa);
  const std::map<std::string, Case> all = cases(3);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(18));
  for (std::size_t f = 0; f < wide.count; ++f) {
    const WideFunction& function = wide.functions[f];
    const std::vector<Column> in = make_inputs(all.at(function.name), function.inputs);
    std::vector<Column> shuffled(in.size());
    for (std::size_t k = 0; k < in.size(); ++k)
      for (std::size_t i = 0; i < count; ++i) shuffled[k].words[i] = in[k].words[order[i]];
    const std::vector<Column> expected = run(function, loaded.scene, in),
                              found = run(function, loaded.scene, shuffled);
    int different = 0;
    for (std::size_t k = 0; k < found.size(); ++k)
      for (std::size_t i = 0; i < count; ++i) different += found[k].words[i] != expected[k].words[order[i]];
    EXPECT_EQ(different, 0) << isa_name(isa) << ", " << function.name;
  }
}

class WideFunctionsOf : public ::testing::TestWithParam<Isa> {};

TEST_P(WideFunctionsOf, EqualTheScalarOnes) { expect_equal_functions(GetParam(), 3); }

/// Short tables are looked up in registers, long ones in memory.
TEST_P(WideFunctionsOf, EqualTheScalarOnesWithManyLights) { expect_equal_functions(GetParam(), 40); }

TEST_P(WideFunctionsOf, GiveEachLaneItsOwn) { expect_independent_lanes(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Isa, WideFunctionsOf, ::testing::ValuesIn(available_isas()),
                         [](const auto& info) { return std::string(isa_name(info.param)); });

}  // namespace
}  // namespace etendue

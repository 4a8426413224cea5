#include "course/probe.h"

#include "base/error.h"
#include "base/hash.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <numbers>

namespace etendue {

namespace {

using Vec3d = Vec3<double>;

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(hash64(seed)) {}
  double between(double low, double high) {
    state_ = hash64(state_ + 1);
    return low + (high - low) * (double(state_ >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t state_;
};

/// Where a probe's own upright world lies in the scene's.
struct Placing {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, at{0, 0, 0};

  Vec3d direction(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d point(const Vec3d& p) const { return at + direction(p); }
};

Placing any_placing(Numbers& numbers) {
  const double height = numbers.between(-0.8, 0.8), turn = numbers.between(0, 2 * std::numbers::pi);
  const double flat = std::sqrt(1 - height * height);
  Placing placing;
  placing.z = {flat * std::cos(turn), flat * std::sin(turn), height};
  placing.x = normalize(cross(placing.z, Vec3d{numbers.between(0.3, 1), numbers.between(-1, -0.3), 0.2}));
  placing.y = cross(placing.z, placing.x);
  placing.at = {numbers.between(-1, 1), numbers.between(-1, 1), numbers.between(-1, 1)};
  return placing;
}

/// Shapes and rays in the probe's own world, where receivers lie about the origin and look up.
class ProbeBuilder {
 public:
  ProbeBuilder(Probe& probe, const Placing& placing) : probe_(probe), placing_(placing) {}

  struct Surface {
    std::string bsdf = R"(<bsdf type="diffuse"><color name="albedo" value="0, 0, 0"/></bsdf>)";
    Colorf radiance{0, 0, 0};
  };

  /// A convex polygon, counter-clockwise seen from its front, as a fan. \param normals one a corner, or none
  void polygon(const std::vector<Vec3d>& corners, const Surface& surface,
               const std::vector<Vec3d>& normals = {}) {
    std::vector<std::array<int, 3>> triangles;
    for (int i = 2; i < int(corners.size()); ++i) triangles.push_back({0, i - 1, i});
    mesh(corners, triangles, surface, normals);
  }

  void mesh(const std::vector<Vec3d>& corners, const std::vector<std::array<int, 3>>& triangles,
            const Surface& surface, const std::vector<Vec3d>& normals = {}) {
    std::string text;
    const auto line = [&](const char* key, const Vec3d& v) {
      text += fmt::format("{} {} {} {}\n", key, v.x, v.y, v.z);
    };
    for (const Vec3d& corner : corners) line("v", placing_.point(corner));
    for (const Vec3d& normal : normals) line("vn", placing_.direction(normal));
    for (const auto& [a, b, c] : triangles)
      text += normals.empty() ? fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1)
                              : fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", a + 1, b + 1, c + 1);
    const std::string file = fmt::format("{}_{}.obj", probe_.name, probe_.files.size());
    shapes_ +=
        fmt::format("  <mesh type=\"obj\"><string name=\"filename\" value=\"{}\"/>{}", file, surface.bsdf);
    if (const Colorf& l = surface.radiance; l.r + l.g + l.b > 0)
      shapes_ += fmt::format(
          R"(<luminaire type="area"><color name="radiance" value="{}, {}, {}"/></luminaire>)", l.r, l.g, l.b);
    shapes_ += "</mesh>\n";
    probe_.files.emplace_back(file, text);
  }

  /// A ray that meets `target` from `direction` (away from it), from this far.
  void ray(const Vec3d& target, const Vec3d& direction, double distance) {
    const Vec3d away = normalize(direction);
    probe_.rays.push_back(
        {narrow(placing_.point(target + away * distance)), narrow(normalize(placing_.direction(-away)))});
  }

  /// \param rays_from where a picture of the probe is taken from
  void finish(const Vec3d& rays_from) {
    const auto text = [](const Vec3d& v) { return fmt::format("{}, {}, {}", v.x, v.y, v.z); };
    probe_.scene_xml = fmt::format(
        "<scene>\n  <integrator type=\"light\"/>\n  <sampler type=\"independent\"/>\n"
        "  <camera type=\"perspective\"><transform name=\"toWorld\"><scale value=\"-1, 1, 1\"/>"
        "<lookat origin=\"{}\" target=\"{}\" up=\"{}\"/></transform><float name=\"fov\" value=\"50\"/>"
        "<integer name=\"width\" value=\"256\"/><integer name=\"height\" value=\"256\"/></camera>\n{}"
        "</scene>\n",
        text(placing_.point(rays_from)), text(placing_.point({0, 0, 0.3})), text(placing_.z), shapes_);
  }

 private:
  Probe& probe_;
  Placing placing_;
  std::string shapes_;
};

std::string diffuse(double r, double g, double b) {
  return fmt::format(R"(<bsdf type="diffuse"><color name="albedo" value="{}, {}, {}"/></bsdf>)", r, g, b);
}

std::string phong(double exponent) {
  return fmt::format(R"(<bsdf type="phong"><color name="kd" value="0.3, 0.25, 0.35"/>)"
                     R"(<color name="ks" value="0.45, 0.5, 0.4"/><float name="n" value="{}"/></bsdf>)",
                     exponent);
}

/// A polygon of `corners` corners about a centre, as wide as `radius`, facing `normal`.
std::vector<Vec3d> about(const Vec3d& center, const Vec3d& normal, double radius, int corners, double turn) {
  const Vec3d n = normalize(normal);
  const Vec3d u = normalize(cross(n, std::abs(n.x) > 0.7 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}));
  const Vec3d v = cross(n, u);
  std::vector<Vec3d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 2 * std::numbers::pi * i / corners;
    polygon.push_back(center + u * (radius * std::cos(angle)) + v * (0.7 * radius * std::sin(angle)));
  }
  return polygon;
}

/// 0.5 r^2 sin of the angle for each corner, of `about`.
double area_about(double radius, int corners) {
  return 0.35 * radius * radius * corners * std::sin(2 * std::numbers::pi / corners);
}

std::vector<Vec3d> square(double half, double z) {
  return {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
}

/// Rays to places on the ground, from above.
void rays_to_ground(ProbeBuilder& builder, Numbers& numbers, int count, double radius,
                    double distance = 0.3) {
  for (int i = 0; i < count; ++i) {
    const double turn = numbers.between(0, 2 * std::numbers::pi), far = radius * numbers.between(0.2, 1);
    const double view = numbers.between(0, 2 * std::numbers::pi), slope = numbers.between(0.2, 1.6);
    builder.ray({far * std::cos(turn), far * std::sin(turn), 0},
                {slope * std::cos(view), slope * std::sin(view), 1}, distance);
  }
}

constexpr Colorf red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, violet{0.5f, 0, 0.5f};

/// Lights of other areas and corners about the ground. Each has a colour of its own, so that a colour's mean
/// is a light's.
void lights_around(ProbeBuilder& builder, Numbers& numbers, const std::vector<Colorf>& colors) {
  constexpr int corners[]{5, 3, 8, 4};
  const double start = numbers.between(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double turn = start + 2 * std::numbers::pi * double(i) / double(colors.size());
    const double radius = std::sqrt(0.015 * (1 + 3 * double(i))) * numbers.between(0.9, 1.2);
    const Vec3d center{1.1 * std::cos(turn), 1.1 * std::sin(turn), numbers.between(0.75, 1.5)};
    const Vec3d aim = Vec3d{numbers.between(-0.3, 0.3), numbers.between(-0.3, 0.3), 0} - center;
    const double power = numbers.between(1, 5);
    builder.polygon(about(center, aim, radius, corners[i % 4], numbers.between(0, 6)),
                    {.radiance = colors[i] * float(power / area_about(radius, corners[i % 4]))});
  }
}

void one_light(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.7, 0.5, 0.3)});
  const double height = numbers.between(0.8, 1.5), half = numbers.between(0.25, 0.5);
  const Vec3d center{numbers.between(-0.4, 0.4), numbers.between(-0.4, 0.4), height};
  builder.polygon(about(center, {numbers.between(-0.3, 0.3), numbers.between(-0.3, 0.3), -1}, half, 4, 0.7),
                  {.radiance = {12, 9, 6}});
  rays_to_ground(builder, numbers, 4, 1.2);
  // Past the light, from where only its back could be seen.
  builder.ray({1.1, numbers.between(-0.3, 0.3), 0}, {0.05, 0, 1}, 2.8);
}

void several_lights(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = phong(numbers.between(5, 15))});
  lights_around(builder, numbers, {red, green, blue, violet});
  rays_to_ground(builder, numbers, 5, 0.6);
}

void three_lights(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.4, 0.6, 0.8)});
  lights_around(builder, numbers, {red, green, blue});
  rays_to_ground(builder, numbers, 4, 0.6);
}

void facing_away(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.6, 0.7, 0.5)});
  const auto light = [&](const Vec3d& center, const Vec3d& normal, const Colorf& color) {
    builder.polygon(about(center, normal, 0.35, 5, numbers.between(0, 6)), {.radiance = color * 8.0f});
  };
  light({0.9, 0.2, numbers.between(0.8, 1.2)}, {-0.4, 0, -1}, red);
  light({-0.8, numbers.between(-0.5, 0.5), 1}, {-0.5, 0.1, 1}, green);
  light({0, -0.9, numbers.between(0.7, 1.1)}, {0.1, -1, 0.3}, blue);
  rays_to_ground(builder, numbers, 4, 0.5);
  // A plate out of the others' way that looks down: its back is lit, and looked at.
  const Vec3d aside{numbers.between(-0.1, 0.1), 1.9, 0.4};
  builder.polygon(about(aside, {0, 0, -1}, 0.15, 4, 0.7), {.bsdf = diffuse(0.7, 0.7, 0.7)});
  builder.ray(aside, {numbers.between(-0.3, 0.3), numbers.between(-0.3, 0.3), 1}, 0.2);
}

/// The ground's shading normals lean over: what is low on one side is below their horizon.
void leaning_normals(ProbeBuilder& builder, Numbers& numbers) {
  const double lean = numbers.between(0.6, 0.8);
  const Vec3d normal{std::sin(lean), 0, std::cos(lean)};
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.8, 0.7, 0.6)}, std::vector<Vec3d>(4, normal));
  const auto light = [&](const Vec3d& center, const Colorf& color) {
    builder.polygon(about(center, -center, 0.25, 4, numbers.between(0, 6)), {.radiance = color * 10.0f});
  };
  light({1, 0.3, numbers.between(0.8, 1.2)}, red);
  light({-1.2, numbers.between(-0.2, 0.2), 0.4}, green);
  light({-1, numbers.between(0.5, 0.8), 1.05}, blue);
  for (int i = 0; i < 4; ++i)
    builder.ray({numbers.between(-0.15, 0.15), numbers.between(-0.3, 0.3), 0},
                {numbers.between(0.2, 0.8), numbers.between(-0.6, 0.6), 1}, 0.3);
}

void blocker(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.5, 0.6, 0.7)});
  const auto light = [&](const Vec3d& center, double radius, const Colorf& color) {
    builder.polygon(about(center, -center, radius, 4, 0.6), {.radiance = color * 12.0f});
  };
  light({0.1, 0, numbers.between(1.5, 1.8)}, 0.4, red);
  light({1.4, numbers.between(-0.3, 0.3), 1}, 0.3, green);
  light({-1.3, numbers.between(-0.3, 0.3), 1.1}, 0.3, blue);
  const double half = numbers.between(0.25, 0.4);
  builder.polygon(square(half, 0.7), {.bsdf = diffuse(0.1, 0.1, 0.1)});
  for (const double far : {0.0, 0.35, 0.6, 0.9})
    builder.ray({far * numbers.between(0.8, 1.2), numbers.between(-0.1, 0.1), 0},
                {numbers.between(-0.6, 0.6), numbers.between(-0.6, 0.6), 1}, 0.3);
}

/// A small light hides a part of a large one.
void light_before_light(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.7, 0.6, 0.5)});
  const double height = numbers.between(0.6, 0.8);
  builder.polygon(about({0, 0, 2 * height}, {0, 0, -1}, 0.5, 6, 0.2), {.radiance = red * 15.0f});
  builder.polygon(about({0, 0, height}, {0, 0, -1}, numbers.between(0.3, 0.4), 5, 0.5),
                  {.radiance = green * 6.0f});
  builder.polygon(about({1.5, 0.2, 1}, {-1, 0, -0.6}, 0.3, 4, 0.3), {.radiance = blue * 12.0f});
  for (const double far : {0.05, 0.2, 0.45, 0.8})
    builder.ray({numbers.between(-0.1, 0.1), far * numbers.between(0.8, 1.2), 0},
                {numbers.between(-0.6, 0.6), numbers.between(-0.6, 0.6), 1}, 0.3);
}

/// Light of two flat halves, whose vertex normals want to be round.
void coarse_curved_light(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.6, 0.6, 0.6)});
  const double z = numbers.between(0.7, 1), rise = numbers.between(0.35, 0.5), half = 0.5;
  const Vec3d down{0, 0, -1}, left = normalize(Vec3d{-rise, 0, -half}),
                              right = normalize(Vec3d{rise, 0, -half});
  builder.mesh({{-half, -half, z + rise},
                {-half, half, z + rise},
                {0, -half, z},
                {0, half, z},
                {half, -half, z + rise},
                {half, half, z + rise}},
               {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}, {.radiance = {7, 5, 3}},
               {left, left, down, down, right, right});
  for (int i = 0; i < 4; ++i)
    builder.ray({(i < 2 ? -1 : 1) * numbers.between(0.5, 1.3), numbers.between(-0.4, 0.4), 0},
                {numbers.between(-0.6, 0.6), numbers.between(-0.6, 0.6), 1}, 0.2);
}

/// A light that stands on the ground; some places lie in its plane to the bit, so this probe is not turned.
void touching_light(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2, 0), {.bsdf = diffuse(0.5, 0.5, 0.5)});
  builder.polygon({{0, -0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0.75}, {0, -0.5, 0.75}}, {.radiance = {4, 6, 8}});
  builder.ray({numbers.between(0.2, 0.3), numbers.between(-0.4, 0.4), 0}, {0.5, 0, 1}, 0.2);
  builder.ray({numbers.between(0.5, 0.8), numbers.between(-0.4, 0.4), 0}, {0.4, 0, 1}, 0.3);
  for (const double y : {-1.0, 0.75, 1.25}) builder.ray({0, y, 0}, {0, 0.25, 1}, 0.5);
}

void lights_in_view(ProbeBuilder& builder, Numbers& numbers) {
  builder.polygon(square(2.5, 0), {.bsdf = diffuse(0.5, 0.5, 0.5)});
  const Vec3d first{-0.5, numbers.between(-0.2, 0.2), 1}, second{0.7, numbers.between(-0.2, 0.2), 1.2};
  // Each reflects some of the other's light.
  builder.polygon(about(first, {0.3, 0.2, -1}, 0.3, 6, 0),
                  {.bsdf = diffuse(0.8, 0.8, 0.8), .radiance = {3, 2, 7}});
  builder.polygon(about(second, {-0.2, 0.3, -1}, 0.4, 4, 0),
                  {.bsdf = diffuse(0.7, 0.8, 0.6), .radiance = {5, 8, 1}});
  builder.ray(first, {numbers.between(-0.5, 0.8), 0, -1}, 0.5);
  builder.ray(second, {numbers.between(-0.8, 0.5), 0.2, -1}, 0.5);
  builder.ray(first, {0, numbers.between(-0.5, 0.5), 1}, 0.5);
  // Past everything, into the sky.
  builder.ray({0, 0, 2}, {0, 0.2, -1}, 0.3);
}

}  // namespace

std::vector<Probe> make_probes(std::uint64_t seed) {
  struct Kind {
    const char *name, *what;
    ProbeOf of;
    bool has_blockers;
    void (*build)(ProbeBuilder&, Numbers&);
    bool is_turned = true;
  };
  static constexpr Kind kinds[]{
      {"one_light", "one light above a diffuse ground", ProbeOf::unshadowed, false, one_light, false},
      {"several_lights", "four lights of different sizes, powers and shapes about a glossy ground",
       ProbeOf::unshadowed, false, several_lights},
      {"three_lights", "three lights about a diffuse ground", ProbeOf::unshadowed, false, three_lights},
      {"facing_away", "three lights, two of which are turned away, and a plate that is seen from behind",
       ProbeOf::back_faces, false, facing_away},
      {"leaning_normals", "a ground whose shading normals lean over: some lights are below their horizon",
       ProbeOf::horizon, false, leaning_normals},
      {"blocker", "a plate hides one of three lights", ProbeOf::shadows, true, blocker},
      {"light_before_light", "a small light hides a part of a large one", ProbeOf::shadows, true,
       light_before_light},
      {"coarse_curved_light", "a bent light with vertex normals", ProbeOf::unshadowed, false,
       coarse_curved_light},
      {"touching_light", "a light that stands on the ground", ProbeOf::unshadowed, false, touching_light,
       false},
      {"lights_in_view", "lights that the camera sees and that light each other, their backs, and the sky",
       ProbeOf::emission, false, lights_in_view}};
  std::vector<Probe> probes;
  for (const Kind& kind : kinds) {
    Numbers numbers(seed * 0x9e3779b97f4a7c15u + probes.size());
    Probe& probe = probes.emplace_back();
    probe.name = kind.name;
    probe.what = kind.what;
    probe.of = kind.of;
    probe.has_blockers = kind.has_blockers;
    ProbeBuilder builder(probe, kind.is_turned ? any_placing(numbers) : Placing{});
    kind.build(builder, numbers);
    builder.finish({0.3, -3.2, 2.4});
  }
  return probes;
}

LoadedScene load_probe(const Probe& probe, const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream file(folder / name, std::ios::binary);
    if (!(file << text)) throw InputError(fmt::format("cannot write {}", (folder / name).string()));
  };
  for (const auto& [name, text] : probe.files) write(name, text);
  write(probe.name + ".xml", probe.scene_xml);
  return load_scene(read_nori_xml(folder / (probe.name + ".xml"), Dialect::nori_2012));
}

}  // namespace etendue

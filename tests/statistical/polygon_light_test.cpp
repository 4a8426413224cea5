// Meshes and rectangles by every technique, as whole lights and facet by facet: what their samples add up to,
// and that hits have the density of the samples that find them.
//
// False-alarm rate of this file: 1e-5 (Sidak over its tests), fixed seeds.
// Seen to fail when: the share of a facet is left out of a sample's density; facets are numbered as
// triangles; the back of a polygon is always seen as its front; the frame is not turned there; receivers that
// scatter from both sides get the cosine's density; a fan's triangles are chosen with wrong shares; hits have
// the density of another technique, or that without the lobe; u is not stretched back where a sample is by
// the lobe; a lobe's density has the third power of the length; its x is not turned behind a polygon; the
// distance of a sample has no bound.
#include "light/light.h"
#include "polygon_cases.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <array>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <span>
#include <string>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 500;  // At least as many tests as are made below.
constexpr int samples = 20000;

constexpr std::array techniques{LightTechnique::area, LightTechnique::solid_angle,
                                LightTechnique::projected_solid_angle, LightTechnique::automatic,
                                LightTechnique::transformed_cosine};

/// A flat hexagon, a square and a sliver, bent against each other: three facets of eight triangles.
Mesh bent_mesh() {
  Mesh mesh;
  mesh.positions = {{0, 0, 2},        {1, 0, 2},     {1.5f, 0.8f, 2}, {1, 1.6f, 2},        {0, 1.6f, 2},
                    {-0.5f, 0.8f, 2}, {1, -1, 2.5f}, {0, -1, 2.5f},   {0.5f, -1.05f, 2.6f}};
  mesh.indices = {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 5, 4, 0, 1, 6, 0, 6, 7, 7, 6, 8};
  return mesh;
}

struct Scene {
  Geometry geometry;
  Lights lights;
  std::vector<std::vector<Vec3f>> polygons;  ///< Of all that shines.
};

Scene mesh_scene(bool is_twosided) {
  Scene scene;
  const Mesh mesh = bent_mesh();
  const std::int32_t id = scene.geometry.add_mesh(mesh, {0, 0});
  scene.lights.add<MeshLights>({1, 1, 1}, "mesh", scene.geometry, id);
  if (is_twosided) scene.lights.set_twosided(0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    scene.polygons.push_back({mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                              mesh.positions[mesh.indices[3 * t + 2]]});
  return scene;
}
Scene rectangle_scene(bool is_twosided) {
  Scene scene;
  scene.lights.add<RectangleLights>({1, 1, 1}, "rectangle", Vec3f{-0.5f, 0, 2}, Vec3f{0, 1.2f, 0.2f},
                                    Vec3f{1.5f, 0, 0});
  if (is_twosided) scene.lights.set_twosided(0);
  scene.polygons.push_back({{-0.5f, 0, 2}, {-0.5f, 1.2f, 2.2f}, {1, 1.2f, 2.2f}, {1, 0, 2}});
  return scene;
}

/// Of an element at the receiver, over that of radiance 1 from everywhere, times pi.
double irradiance(const Scene& scene, bool is_twosided, const Receiver<float>& receiver) {
  long double sum = 0;
  for (const std::vector<Vec3f>& polygon : scene.polygons) {
    Outline seen = PolygonCase{polygon, receiver.position, receiver.ns}.outline();
    const bool is_front = solid_angle(seen) > 0;
    if (!is_front) std::reverse(seen.begin(), seen.end());
    if (is_front || is_twosided) sum += projected_solid_angle(seen, extended(receiver.ns));
  }
  return double(sum);
}

/// None where a side of two facets is so near that rounding decides between them.
std::optional<LightHit<float>> hit_of(const Scene& scene, const Receiver<float>& receiver,
                                      const LightSample<float>& sample, bool is_facet_chosen,
                                      LightTechnique technique) {
  // Where the segment ends, but for the clearance; the normal of the polygon there, on the receiver's side.
  const Vec3f at = sample.end;
  Vec3f ng{0, 0, 0};
  double nearest = 1e9, next_facet = 1e9;
  std::int32_t primitive = 0;
  for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
    const std::vector<Vec3f>& polygon = scene.polygons[p];
    const Vec3f n = normalize(cross(polygon[1] - polygon[0], polygon[2] - polygon[0]));
    double outside = std::abs(double(dot(n, at - polygon[0])));
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3f side = polygon[(k + 1) % polygon.size()] - polygon[k];
      outside = std::max(outside, -double(dot(cross(side, at - polygon[k]), n)) / length(side));
    }
    const std::int32_t facet = scene.lights.facet_at<float>(0, std::int32_t(p), {}, true);
    if (outside < nearest) {
      if (facet != scene.lights.facet_at<float>(0, primitive, {}, true)) next_facet = nearest;
      nearest = outside, ng = n, primitive = std::int32_t(p);
    } else if (facet != scene.lights.facet_at<float>(0, primitive, {}, true)) {
      next_facet = std::min(next_facet, outside);
    }
  }
  if (next_facet < 2e-5) return std::nullopt;
  if (dot(ng, sample.wi) > 0) ng = -ng;
  const float distance = dot(at - receiver.position, sample.wi);
  return LightHit<float>{receiver.position + sample.wi * distance,
                         ng,
                         sample.wi,
                         scene.lights.facet_at<float>(0, primitive, {}, true),
                         is_facet_chosen,
                         technique};
}

void expect_irradiance(const Scene& scene, bool is_twosided, const Receiver<float>& receiver,
                       const std::string& what, std::span<const LightTechnique> by = techniques) {
  const double exact = irradiance(scene, is_twosided, receiver);
  const std::int32_t facets = scene.lights.facet_count(0);
  for (const LightTechnique technique : by)
    for (const bool is_by_facet : {false, true}) {
      std::mt19937 random(3);
      RunningStatistics statistics;
      for (int i = 0; i < samples; ++i) {
        const std::int32_t facet = is_by_facet ? std::int32_t(random() % std::uint32_t(facets)) : whole_light;
        const float pmf = is_by_facet ? 1 / float(facets) : 1;
        const std::uint32_t u_x = random();
        const LightSample<float> sample = scene.lights.sample<float>(
            0, pmf, receiver, {u_x, std::uint32_t(random())}, true, facet, technique);
        double value = 0;
        if (sample.is_there) {
          const double cosine = dot(sample.wi, receiver.ns);
          value = std::max(cosine, 0.0) * sample.radiance_over_pdf.r;
          EXPECT_NEAR(length(sample.wi), 1, 1e-6);
          if (i % 16 == 0 && cosine > 1e-3) {
            const auto hit = hit_of(scene, receiver, sample, is_by_facet, technique);
            const float found = hit ? scene.lights.pdf_solid_angle<float>(0, pmf, receiver, *hit, true)
                                    : sample.pdf_solid_angle;
            EXPECT_NEAR(found, sample.pdf_solid_angle, 1e-4 * sample.pdf_solid_angle)
                << what << ", technique " << light_technique_name(technique);
          }
          EXPECT_NEAR(sample.radiance_over_pdf.r * sample.pdf_solid_angle, 1, 1e-5);
        }
        statistics.add(value);
      }
      const MeanTest test = t_test(statistics, exact, exact * exact * 1e-10);
      EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
          << what << ", technique " << light_technique_name(technique) << (is_by_facet ? ", by facet" : "")
          << ": " << statistics.mean << " +- " << statistics.standard_error() << ", exact " << exact;
    }
}

constexpr std::int32_t front = lit_side::front, both = lit_side::front | lit_side::back;

TEST(PolygonLights, SendWhatLambertSaysByEveryTechnique) {
  const Vec3f up{0, 0, 1}, tilted = normalize(Vec3f{0.9f, 0.3f, 0.2f});
  const std::vector<std::pair<std::string, Receiver<float>>> receivers{
      {"below", {{0.3f, 0.2f, 0}, up, up, front}},
      {"tilted", {{-1, 0.1f, 1.2f}, tilted, tilted, front}},
      {"near", {{0.4f, 0.7f, 1.9f}, up, up, front}},
      {"far", {{3, 2, -15}, up, up, front}},
      {"above", {{0.2f, 0.6f, 3.5f}, -up, -up, front}}};
  for (const bool is_twosided : {false, true})
    for (const auto& [name, receiver] : receivers) {
      const std::string what = name + (is_twosided ? ", two-sided" : "");
      expect_irradiance(mesh_scene(is_twosided), is_twosided, receiver, "mesh, " + what);
      expect_irradiance(rectangle_scene(is_twosided), is_twosided, receiver, "rectangle, " + what);
    }
}

TEST(PolygonLights, SendTheSameToGlossyReceivers) {
  GlossyLobes lobes;
  for (const float roughness : {0.03f, 0.4f})
    for (const float diffuse : {0.0f, 0.5f}) {
      const GlossyLobe lobe{ltc::ggx, roughness, [](float) { return 0.5f; }, diffuse};
      lobes.add(&lobe);
    }
  const Vec3f up{0, 0, 1};
  for (const bool is_twosided : {false, true})
    for (const Vec3f& position : {Vec3f{0.3f, 0.2f, 0}, {0.4f, 0.7f, 1.8f}, {3, 2, -9}, {0.2f, 0.6f, 3.5f}})
      for (std::int32_t material = 0; material < 4; ++material) {
        const Vec3f ns = position.z > 3 ? -up : up;
        Receiver<float> receiver{position, ns, ns, front};
        receiver.lobes = &lobes;
        receiver.material = material;
        // The mirror image of the viewer is on the light, then beside it.
        const Vec3f place = material % 2 == 0 ? Vec3f{0.3f, 0.4f, 2} : Vec3f{-0.8f, 0.4f, 2};
        const Vec3f to_light = normalize(place - position);
        receiver.wo = ns * (2 * dot(ns, to_light)) - to_light;
        const std::string what = ", lobe " + std::to_string(material) + (is_twosided ? ", two-sided" : "");
        constexpr std::array by_lobe{LightTechnique::automatic, LightTechnique::transformed_cosine};
        expect_irradiance(mesh_scene(is_twosided), is_twosided, receiver, "mesh" + what, by_lobe);
        expect_irradiance(rectangle_scene(is_twosided), is_twosided, receiver, "rectangle" + what, by_lobe);
      }
}

TEST(PolygonLights, ShineIntoAPhongLobeAsAlongItsAxis) {
  // A regular polygon with the area of a disk that is seen under 5 degrees (half). Of the lobe cos^n a part
  // 1 - cos^(n + 1) 5 degrees is there.
  constexpr int corners = 64;
  const double half_angle = 5 * std::numbers::pi / 180, inner = 2 * std::numbers::pi / corners;
  const double radius = std::tan(half_angle) * std::sqrt(inner / std::sin(inner));
  Mesh mesh;
  mesh.positions.push_back({0, 0, 1});
  for (int k = 0; k < corners; ++k)
    mesh.positions.push_back({float(radius * std::cos(k * inner)), float(radius * std::sin(k * inner)), 1});
  for (std::uint32_t k = 0; k < corners; ++k)
    mesh.indices.insert(mesh.indices.end(), {0, 1 + (k + 1) % corners, 1 + k});
  Scene scene;
  scene.lights.add<MeshLights>({1, 1, 1}, "disk", scene.geometry, scene.geometry.add_mesh(mesh, {0, 0}));
  for (const auto& [exponent, exact] :
       {std::pair{10, 0.041070926}, std::pair{100, 0.319596048}, std::pair{1000, 0.977992524}}) {
    GlossyLobes lobes;
    const GlossyLobe lobe{ltc::phong, std::sqrt(2 / (float(exponent) + 2)), [](float) { return 1.0f; }, 0};
    lobes.add(&lobe);
    const Vec3f up{0, 0, 1};
    Receiver<float> receiver{{0, 0, 0}, up, up, front};
    receiver.lobes = &lobes;
    receiver.wo = up;
    for (const LightTechnique technique : techniques) {
      std::mt19937 random(6);
      RunningStatistics statistics;
      for (int i = 0; i < 4 * samples; ++i) {
        const std::uint32_t u_x = random();
        const LightSample<float> sample = scene.lights.sample<float>(
            0, 1, receiver, {u_x, std::uint32_t(random())}, true, whole_light, technique);
        const double density = (exponent + 1) / (2 * std::numbers::pi) * std::pow(sample.wi.z, exponent);
        statistics.add(sample.is_there ? density * sample.radiance_over_pdf.r : 0);
      }
      const MeanTest test = t_test(statistics, exact, exact * exact * 1e-9);
      EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
          << "exponent " << exponent << ", technique " << light_technique_name(technique) << ": "
          << statistics.mean << " +- " << statistics.standard_error() << ", exact " << exact;
    }
  }
}

TEST(PolygonLights, AreSampledOnBothSidesOfAReceiverThatScattersThere) {
  // What is scattered from both sides is sampled by solid angle: all of a light that stands across the
  // horizon.
  Scene scene;
  scene.lights.add<RectangleLights>({1, 1, 1}, "rectangle", Vec3f{2, -1, -1}, Vec3f{0, 0, 2}, Vec3f{0, 2, 0});
  std::mt19937 random(9);
  int below = 0;
  for (int i = 0; i < 1000; ++i) {
    const Receiver<float> receiver{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, both};
    const std::uint32_t u_x = random();
    const LightSample<float> sample =
        scene.lights.sample<float>(0, 1, receiver, {u_x, std::uint32_t(random())}, true, whole_light,
                                   LightTechnique::projected_solid_angle);
    below += sample.is_there && sample.wi.z < 0;
  }
  EXPECT_NEAR(below, 500, 100);
}

TEST(PolygonLights, LeaveADiffuseReceiverThatSeesAllOfThemNoVariance) {
  const Vec3f up{0, 0, 1};
  for (const bool is_twosided : {false, true})
    for (const Vec3f& position :
         {Vec3f{0.2f, 0.3f, 0}, {-2, 1, 1}, {5, 5, 0}, {0.1f, 0.1f, 1.95f}, {0, 2, 4}}) {
      const bool is_behind = position.z > 2.2f;
      if (is_behind && !is_twosided) continue;
      const Scene scene = rectangle_scene(is_twosided);
      const Vec3f ns = is_behind ? -up : up;
      const Receiver<float> receiver{position, ns, ns, front};
      std::mt19937 random(4);
      RunningStatistics statistics;
      for (int i = 0; i < 2000; ++i) {
        const std::uint32_t u_x = random();
        const LightSample<float> sample =
            scene.lights.sample<float>(0, 1, receiver, {u_x, std::uint32_t(random())}, true, whole_light,
                                       LightTechnique::projected_solid_angle);
        ASSERT_TRUE(sample.is_there);
        statistics.add(double(dot(sample.wi, ns)) * sample.radiance_over_pdf.r);
      }
      const double exact = irradiance(scene, is_twosided, receiver);
      EXPECT_NEAR(statistics.mean, exact, 1e-4 * exact);
      EXPECT_LT(std::sqrt(statistics.variance()), 1e-4 * exact);
    }
}

TEST(PolygonLights, EndShadowSegmentsOnThemselvesAlongTheirOwnPlane) {
  // Far parts of a huge light close above the receiver: rounding hides on which side of its plane they are.
  Scene scene;
  constexpr float half = 1e5f;
  scene.lights.add<RectangleLights>({1, 1, 1}, "ceiling", Vec3f{-half, -half, 1e-2f}, Vec3f{0, 2 * half, 0},
                                    Vec3f{2 * half, 0, 0});
  const Vec3f ns = normalize(Vec3f{1, 0, 0.3f});
  const Receiver<float> receiver{{0, 0, 0}, ns, ns, front};
  std::mt19937 random(10);
  for (int i = 0; i < samples; ++i) {
    // Along the sides.
    const std::uint32_t edge = i % 2 == 0 ? 0 : 0xffffffff, other = random();
    const Vec2<std::uint32_t> u =
        i % 4 < 2 ? Vec2<std::uint32_t>{edge, other} : Vec2<std::uint32_t>{other, edge};
    const LightSample<float> sample = scene.lights.sample<float>(0, 1, receiver, u, true, whole_light,
                                                                 LightTechnique::projected_solid_angle);
    if (!sample.is_there) continue;
    EXPECT_LE(length(sample.end), 1.5f * half);
    EXPECT_GT(dot(sample.end, sample.wi), 0);
    EXPECT_TRUE(sample.pdf_solid_angle > 0 && std::isfinite(sample.pdf_solid_angle));
  }
}

}  // namespace
}  // namespace etendue

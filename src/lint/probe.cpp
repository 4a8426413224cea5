#include "lint/probe.h"

#include "base/frame.h"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace etendue {

namespace {

Colorf largest_of(const Colorf& a, const Colorf& b) {
  return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
}

struct LargestColor {
  Colorf operator()(const Colorf& color) const { return color; }
  Colorf operator()(const Checkerboard& board) const { return largest_of(board.even, board.odd); }
  Colorf operator()(const UvTexture&) const { return {1, 1, 0.5f}; }
  Colorf operator()(const ImageTexture& image) const {
    Colorf largest{0, 0, 0};
    for (std::size_t i = 0; i + 3 < image.pixels->size(); i += 4)
      largest = largest_of(largest, {(*image.pixels)[i], (*image.pixels)[i + 1], (*image.pixels)[i + 2]});
    return largest;
  }
};

struct FactsOf {
  MaterialFacts operator()(const Diffuse& m) const {
    return {std::visit(LargestColor{}, m.albedo), false, false, false};
  }
  MaterialFacts operator()(const Phong& m) const { return {m.kd + m.ks, false, false, false}; }
  MaterialFacts operator()(const Mirror&) const { return {{1, 1, 1}, true, false, false}; }
  MaterialFacts operator()(const Dielectric&) const { return {{1, 1, 1}, true, true, false}; }
  MaterialFacts operator()(const Microfacet& m) const {
    // What the coat reflects, the base does not get.
    const auto bound = [&](float kd) { return std::max(kd, std::min(kd + m.ks, 1.0f)); };
    return {{bound(m.kd.r), bound(m.kd.g), bound(m.kd.b)}, false, false, true};
  }
  MaterialFacts operator()(const RoughConductor& m) const {
    return {m.specular_reflectance, false, false, true};
  }
  MaterialFacts operator()(const RoughDielectric&) const { return {{1, 1, 1}, false, true, false}; }
};

}  // namespace

std::optional<ProbeHit> probe(const Scene& scene, const Ray<float>& ray, float t_near, float t_far) {
  const Hit<float> hit = closest_hit(scene, ray, t_near, t_far);
  if (hit.geometry < 0) return std::nullopt;
  return ProbeHit{hit, Vertex<float>(scene, ray, hit), dot(hit.ng, ray.direction) < 0};
}

std::vector<MaterialFacts> facts_of(const Materials& materials) {
  std::vector<MaterialFacts> facts;
  for (std::int32_t id = 0; id < materials.count(); ++id)
    facts.push_back(std::visit(FactsOf{}, materials[id]));
  return facts;
}

View look(const Scene& scene) {
  constexpr int side = 16;
  View view;
  ProbeNumbers numbers(1);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const Vec2f within = numbers.two_units();
      const CameraRay<float> ray =
          scene.camera.ray((float(column) + within.x) / side * float(scene.camera.width_px),
                           (float(row) + within.y) / side * float(scene.camera.height_px));
      View::Seen seen{{ray.origin, ray.direction}, ray.t_near, ray.t_far, {}, {}};
      seen.hit = probe(scene, seen.ray, ray.t_near, ray.t_far);
      seen.unclipped = seen.hit && ray.t_near <= 1e-4f * seen.hit->hit.t ? seen.hit : probe(scene, seen.ray);
      view.hits += seen.hit.has_value();
      view.fronts += seen.hit && seen.hit->is_front;
      view.unclipped_hits += seen.unclipped.has_value();
      view.rays.push_back(std::move(seen));
    }
  return view;
}

bool is_in_view(const Camera& camera, const Vec3f& place) {
  const Vec3<double> x = camera.per_px_x, y = camera.per_px_y, to_corner = camera.at_film_origin;
  const Vec3<double> along = widen(place) - camera.origin;
  const double volume = dot(to_corner, cross(x, y)), depth = dot(along, cross(x, y)) / volume;
  const double from_start = depth - camera.start_depth;
  if (!(from_start > camera.near_clip && from_start < camera.far_clip)) return false;
  const double column = dot(to_corner, cross(along, y)) / volume / depth,
               row = dot(to_corner, cross(x, along)) / volume / depth;
  return column >= 0 && row >= 0 && column <= camera.width_px && row <= camera.height_px;
}

bool is_lit_by(const Scene& scene, const ProbeHit& at, std::int32_t light, int tries, ProbeNumbers& numbers) {
  // A receiver on both sides: the side that the ray has met is told below.
  const Receiver<float> receiver{at.vertex.position, at.vertex.ng, at.vertex.ns,
                                 lit_side::front | lit_side::back};
  for (int k = 0; k < tries; ++k) {
    const LightSample<float> sample =
        scene.lights.sample<float>(light, 1, receiver, numbers.two_bits(), true);
    if (!sample.is_there || !(luminance(sample.radiance_over_pdf) > 0)) continue;
    if (dot(sample.wi, at.vertex.ng) * dot(at.vertex.wo, at.vertex.ng) <= 0) continue;
    if (is_visible(scene, at.vertex.origin_of_ray(sample.wi), sample.end)) return true;
  }
  return false;
}

Vec3f next_direction(const ProbeHit& from, const MaterialFacts& material, ProbeNumbers& numbers) {
  const bool goes_through = material.is_two_sided && numbers.unit() < 0.5f;
  const Vec3f side = from.is_front == goes_through ? -from.vertex.ng : from.vertex.ng;
  return Frame<float>(side).world_from_local(square_to_cosine_hemisphere(numbers.two_units()));
}

}  // namespace etendue

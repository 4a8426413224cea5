#include "render/first_hits.h"

#include "base/frame.h"
#include "integrator/single_sample.h"
#include "integrator/vertex.h"

#include <tbb/parallel_for.h>

namespace etendue {
namespace {

Colorf albedo_of(const Scene& scene, const Vertex<float>& vertex) {
  constexpr int across = 4;
  const Vec3f wo_local = Frame<float>(vertex.ns).local_from_world(vertex.wo);
  Colorf albedo{0, 0, 0};
  for_each_material<float>(
      scene.materials, vertex.material, vertex.uv, vertex.is_surface, [&](const auto& bsdf, bool) {
        for (int k = 0; k < across * across; ++k) {
          const Vec2<float> u_bsdf{(float(k % across) + 0.5f) / across, (float(k / across) + 0.5f) / across};
          const BsdfSample<float> sample = bsdf.sample(wo_local, u_bsdf);
          if (sample.pdf_solid_angle > 0) albedo = albedo + sample.weight * (1.0f / (across * across));
        }
      });
  return albedo;
}

FirstHit first_hit(const Scene& scene, int x, int y) {
  const auto [ray, hit] = centre_hit(scene, x, y);
  FirstHit first;
  if (hit.geometry < 0) return first;
  const Vertex<float> vertex(scene, ray, hit);
  const Vec3f at = ray.origin + ray.direction * hit.t;
  first.position = scene.origin + Vec3<double>{at.x, at.y, at.z};
  first.distance = hit.t;
  first.normal = vertex.ns;
  first.albedo = albedo_of(scene, vertex);
  first.shape = hit.geometry;
  first.material = vertex.material;
  first.light = scene.geometry.light[std::size_t(hit.geometry)];
  return first;
}

}  // namespace

CentreHit centre_hit(const Scene& scene, int x, int y) {
  const float x_px = float(x) + 0.5f, y_px = float(y) + 0.5f;
  const CameraRay<float> camera_ray =
      scene.camera.has_lens ? scene.camera.ray(x_px, y_px, Vec2<float>{0, 0}) : scene.camera.ray(x_px, y_px);
  const Ray<float> ray{camera_ray.origin, camera_ray.direction};
  return {ray, closest_hit(scene, ray, camera_ray.t_near, camera_ray.t_far)};
}

std::vector<FirstHit> first_hits(const Scene& scene) {
  const int width = scene.camera.width_px, height = scene.camera.height_px;
  std::vector<FirstHit> hits(std::size_t(width) * std::size_t(height));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x)
      hits[std::size_t(y) * std::size_t(width) + std::size_t(x)] = first_hit(scene, x, y);
  });
  return hits;
}

}  // namespace etendue

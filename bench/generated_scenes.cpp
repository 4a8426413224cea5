#include "generated_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace etendue::bench {

namespace {

/// (cells + 1)^2 points of `surface(u, v)`, u and v in [0, 1], front where du x dv points.
template <class Surface>
Mesh tessellate(int cells, bool has_normals, const Surface& surface) {
  Mesh mesh;
  const auto point = [&](double u, double v) {
    const Vec3<double> p = surface(u, v);
    return Vec3f{float(p.x), float(p.y), float(p.z)};
  };
  const double step = 1.0 / cells, h = 1e-4;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double u = i * step, v = j * step;
      mesh.positions.push_back(point(u, v));
      if (!has_normals) continue;
      // At the poles of a ball one derivative vanishes; a step inwards gives the same normal.
      const double v_inside = std::min(std::max(v, h), 1 - h);
      mesh.normals.push_back(normalize(cross(point(u + h, v_inside) - point(u - h, v_inside),
                                             point(u, v_inside + h) - point(u, v_inside - h))));
    }
  const auto at = [&](int i, int j) { return std::uint32_t(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

Phong glossy(float exponent) {
  Phong phong;
  phong.kd = {0.3f, 0.3f, 0.3f};
  phong.ks = {0.4f, 0.4f, 0.4f};
  phong.exponent = exponent;
  phong.specular_probability = 0.4f / 0.7f;
  return phong;
}

/// The terrain and the balls above it.
Geometry terrain(int grid, bool has_normals) {
  Geometry geometry;
  geometry.add_mesh(tessellate(grid, has_normals,
                               [](double u, double v) {
                                 const double x = 10 * v - 5, z = 10 * u - 5;
                                 return Vec3<double>{x,
                                                     0.3 * std::sin(3 * x) * std::cos(4 * z) +
                                                         0.05 * std::sin(31 * x) * std::sin(29 * z),
                                                     z};
                               }),
                    {1, -1});
  for (int ball = 0; ball < 64; ++ball) {
    const double center_x = ball % 8 - 3.5, center_z = ball / 8 - 3.5;
    geometry.add_mesh(tessellate(grid / 14 + 4, has_normals,
                                 [=](double u, double v) {
                                   const double theta = std::numbers::pi * (1 - v),
                                                phi = 2 * std::numbers::pi * u;
                                   return Vec3<double>{center_x + 0.3 * std::sin(theta) * std::sin(phi),
                                                       0.8 + 0.3 * std::cos(theta),
                                                       center_z + 0.3 * std::sin(theta) * std::cos(phi)};
                                 }),
                      {ball % 2, -1});
  }
  return geometry;
}

Scene seen_from_the_front(Geometry geometry, Lights lights, int width_px, int height_px) {
  Camera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.origin = {0, 3, 8};
  camera.start = {0, 3, 8};
  const Vec3<double> forward = normalize(Vec3<double>{0, -0.35, -1}), right{1, 0, 0},
                     up = cross(right, forward);
  camera.per_px_x = right * (1.2 / width_px);
  camera.per_px_y = up * (-0.8 / height_px);
  camera.at_film_origin = forward - right * 0.6 + up * 0.4;
  RayCaster rays(geometry);
  return {.camera = camera,
          .filter = PixelFilter::box(),
          .geometry = std::move(geometry),
          .rays = std::move(rays),
          .materials = Materials({Diffuse{}, glossy(50)}),
          .lights = std::move(lights),
          .medium = std::nullopt,
          .sampler = SamplerKind::sobol};
}

}  // namespace

Scene terrain_scene(int grid, int width_px, int height_px, bool has_normals) {
  Geometry geometry = terrain(grid, has_normals);
  Lights lights;
  for (int light = 0; light < 4; ++light) {
    const double corner_x = (light & 1 ? 3 : -3) - 0.5, corner_z = (light & 2 ? 3 : -3) - 0.5;
    const std::int32_t id = geometry.add_mesh(tessellate(4, false,
                                                         [=](double u, double v) {
                                                           return Vec3<double>{corner_x + u, 4, corner_z + v};
                                                         }),
                                              {0, light});
    const float radiance = 10.0f + float(light);
    lights.add<MeshLights>({radiance, radiance, radiance}, "light " + std::to_string(light), geometry, id);
  }

  return seen_from_the_front(std::move(geometry), std::move(lights), width_px, height_px);
}

Scene swarm_scene(int light_count, int width_px, int height_px) {
  constexpr int grid = 65;
  Geometry geometry = terrain(grid, false);
  Lights lights;
  // Evenly spread in a box above the terrain (Roberts' sequence), of one power together.
  const auto place = [](int k, double step, double size) {
    const double share = step * (k + 1);
    return size * (share - std::floor(share) - 0.5);
  };
  const float side = 1 / std::sqrt(float(light_count)), radiance = 10;
  for (int k = 0; k < light_count; ++k) {
    const Vec3f corner{float(place(k, 0.8191725133961645, 8)), float(3 + place(k, 0.6710436067037893, 2)),
                       float(place(k, 0.5497004779019703, 8))};
    Mesh square;
    square.positions = {corner, corner + Vec3f{side, 0, 0}, corner + Vec3f{side, 0, side},
                        corner + Vec3f{0, 0, side}};
    square.indices = {0, 1, 2, 0, 2, 3};
    const std::int32_t id = geometry.add_mesh(square, {0, k});
    lights.add<MeshLights>({radiance, radiance, radiance}, "", geometry, id);
  }
  return seen_from_the_front(std::move(geometry), std::move(lights), width_px, height_px);
}

void shrink(Camera& camera, int width_px) {
  const int height_px = std::max(1, width_px * camera.height_px / camera.width_px);
  camera.per_px_x = camera.per_px_x * (float(camera.width_px) / float(width_px));
  camera.per_px_y = camera.per_px_y * (float(camera.height_px) / float(height_px));
  camera.width_px = width_px;
  camera.height_px = height_px;
}

}  // namespace etendue::bench

#include "course/probe_receiver.h"

#include "course/student_words.h"

#include <array>
#include <cmath>

namespace etendue {

namespace {

using ReceiverTriangle = std::array<Vec3<double>, 3>;

ReceiverTriangle receiver_triangle(const Geometry& geometry, std::int32_t mesh, std::int32_t triangle) {
  const auto first = 3 * std::size_t(geometry.first_triangle[std::size_t(mesh)] + triangle);
  const auto corner = [&](std::size_t k) {
    return widen(geometry.positions[std::size_t(geometry.indices[first + k])]);
  };
  return {corner(0), corner(1), corner(2)};
}

double receiver_triangle_area(const ReceiverTriangle& c) {
  return 0.5 * length(cross(c[1] - c[0], c[2] - c[0]));
}

/// Cells along an edge of a triangle: more where shadows have edges.
constexpr int cells_free = 48, cells_with_rays = 96;

}  // namespace

LoadedProbe::LoadedProbe(const Probe& of, const std::filesystem::path& folder)
    : probe(of), loaded(load_probe(of, folder)), scene(loaded.scene, loaded.places) {
  const Geometry& geometry = loaded.scene.geometry;
  for (std::int32_t mesh = 0; mesh < geometry.count(); ++mesh) {
    const bool is_light = geometry.light[std::size_t(mesh)] >= 0;
    light_of_mesh.push_back(is_light ? std::int32_t(mesh_of_light.size()) : -1);
    if (!is_light) continue;
    mesh_of_light.push_back(mesh);
    double area = 0;
    for (std::int32_t k = 0; k < geometry.triangles[std::size_t(mesh)]; ++k)
      area += receiver_triangle_area(receiver_triangle(geometry, mesh, k));
    light_areas.push_back(area);
  }
}

ProbeReceiver::ProbeReceiver(const LoadedProbe& probe, const ProbeRay& ray)
    : probe_(probe), to_camera_(-ray.direction) {
  is_surface_ =
      probe.scene.rayIntersect(nori::Ray3f(to_student(ray.origin), to_student(ray.direction)), hit_);
}

Colorf ProbeReceiver::emitted() const {
  if (!is_light()) return {0, 0, 0};
  const bool is_front = hit_.geoFrame.n.dot(to_student(to_camera_)) > 0;
  return is_front ? from_student(hit_.mesh->getLuminaire()->getColor()) : Colorf{0, 0, 0};
}

LightPointFacts ProbeReceiver::unshadowed_facts(std::int32_t mesh, const Vec3f& position,
                                                const Vec3f& ng) const {
  LightPointFacts f;
  const Geometry& geometry = probe_.loaded.scene.geometry;
  f.light = probe_.light_of_mesh[std::size_t(mesh)];
  if (f.light < 0) return f;
  const nori::Mesh& light = *probe_.scene.getMeshes()[std::size_t(mesh)];
  f.radiance = from_student(light.getLuminaire()->getColor());
  f.area = probe_.light_areas[std::size_t(f.light)];
  f.first_triangle_area = receiver_triangle_area(receiver_triangle(geometry, mesh, 0));
  f.triangle_count = geometry.triangles[std::size_t(mesh)];

  const Vec3<double> from = widen(from_student(hit_.p)), along = widen(position) - from;
  f.distance = length(along);
  f.direction = along / f.distance;
  const nori::Vector3f to_light = to_student(narrow(f.direction)), to_camera = to_student(to_camera_);
  f.cos_receiver = dot(f.direction, widen(from_student(hit_.shFrame.n)));
  f.cos_receiver_geometric = dot(f.direction, widen(from_student(hit_.geoFrame.n)));
  f.cos_light = -dot(f.direction, widen(ng));
  f.cos_light_shading = f.cos_light;
  f.cos_view = double(hit_.shFrame.n.dot(to_camera));

  const nori::BSDF& bsdf = *hit_.mesh->getBSDF();
  const auto value = [&](const nori::Vector3f& wi, const nori::Vector3f& wo) {
    return from_student(bsdf.eval(nori::BSDFQueryRecord(wi, wo)));
  };
  const nori::Vector3f wi = hit_.toLocal(to_camera), wo = hit_.toLocal(to_light);
  f.bsdf = value(wi, wo);
  f.bsdf_of_world = value(to_camera, to_light);
  f.bsdf_geometric = value(hit_.geoFrame.toLocal(to_camera), hit_.geoFrame.toLocal(to_light));
  f.bsdf_mirrored = value(wi, {wo.x(), wo.y(), std::abs(wo.z())});

  if (geometry.has_normals[std::size_t(mesh)] != 0) {
    nori::Intersection at;
    constexpr float off = 1e-3f;
    if (probe_.scene.rayIntersect({to_student(position + ng * off), to_student(-ng), 0, 2 * off}, at))
      f.cos_light_shading = -dot(f.direction, widen(from_student(at.shFrame.n)));
  }
  return f;
}

void ProbeReceiver::find_visibility(LightPointFacts& f) const {
  nori::Intersection between;
  const float end = float(f.distance) * (1 - 1e-4f);
  f.is_visible =
      !probe_.scene.rayIntersect({hit_.p, to_student(narrow(f.direction)), nori::Epsilon, end}, between);
  f.is_hidden_by_light_only = !f.is_visible && between.mesh->isLuminaire();
  f.is_visible_to_student = f.is_visible;
}

LightPointFacts ProbeReceiver::facts(std::int32_t mesh, const Vec3f& position, const Vec3f& ng) const {
  LightPointFacts f = unshadowed_facts(mesh, position, ng);
  if (f.light >= 0) find_visibility(f);
  return f;
}

ExpectedRadiance ProbeReceiver::expected() const {
  const Colorf own = emitted();
  Color<double> sum{0, 0, 0}, square{0, 0, 0};
  const int cells = probe_.probe.has_blockers ? cells_with_rays : cells_free;
  const Geometry& geometry = probe_.loaded.scene.geometry;
  for (const std::int32_t mesh : probe_.mesh_of_light) {
    if (!is_surface_) break;
    const double light_area = probe_.light_areas[std::size_t(probe_.light_of_mesh[std::size_t(mesh)])];
    for (std::int32_t k = 0; k < geometry.triangles[std::size_t(mesh)]; ++k) {
      const ReceiverTriangle c = receiver_triangle(geometry, mesh, k);
      const Vec3<double> u = (c[1] - c[0]) / double(cells), v = (c[2] - c[0]) / double(cells);
      const Vec3f ng = narrow(normalize(cross(u, v)));
      const double cell_area = receiver_triangle_area(c) / (double(cells) * cells);
      // Each cell is a triangle: the upright ones, and those between, upside down.
      for (int i = 0; i < cells; ++i)
        for (int j = 0; i + j < cells; ++j)
          for (const double third : {1.0 / 3, 2.0 / 3}) {
            if (third > 0.5 && i + j + 1 >= cells) continue;
            const Vec3<double> at = c[0] + u * (i + third) + v * (j + third);
            LightPointFacts f = unshadowed_facts(mesh, narrow(at), ng);
            if (probe_.probe.has_blockers) find_visibility(f);
            f.area = cell_area;
            const Colorf value = right_terms(f).value();
            sum = sum + Color<double>{value.r, value.g, value.b};
            const double inverse_probability = light_area * double(probe_.mesh_of_light.size()) / cell_area;
            square = square + inverse_probability * Color<double>{double(value.r) * value.r,
                                                                  double(value.g) * value.g,
                                                                  double(value.b) * value.b};
          }
    }
  }
  const auto evenness = [](double mean, double mean_square) {
    return mean_square > 0 ? mean * mean / mean_square : 1.0;
  };
  return {sum + Color<double>{own.r, own.g, own.b},
          {evenness(sum.r, square.r), evenness(sum.g, square.g), evenness(sum.b, square.b)}};
}

}  // namespace etendue

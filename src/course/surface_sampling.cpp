#include "course/surface_sampling.h"

#include "base/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

namespace {

/// In global numbers of the geometry's table.
std::array<Vec3f, 3> corners(const Geometry& geometry, std::size_t triangle) {
  const auto corner = [&](std::size_t k) {
    return geometry.positions[std::size_t(geometry.indices[3 * triangle + k])];
  };
  return {corner(0), corner(1), corner(2)};
}

Vec3<double> in_double(const Vec3f& v) { return {v.x, v.y, v.z}; }

double triangle_area(const std::array<Vec3f, 3>& triangle) {
  const Vec3<double> origin = in_double(triangle[0]);
  return 0.5 * length(cross(in_double(triangle[1]) - origin, in_double(triangle[2]) - origin));
}

}  // namespace

SurfaceSampling::SurfaceSampling(const Geometry& geometry, std::int32_t id) : geometry_(&geometry), id_(id) {
  const auto row = std::size_t(id);
  double area = 0;
  if (geometry.sphere[row] >= 0) {
    const double radius = geometry.spheres[std::size_t(geometry.sphere[row])].radius;
    area = 4 * double(pi) * radius * radius;
  } else if (geometry.disk[row] >= 0) {
    const Disk& disk = geometry.disks[std::size_t(geometry.disk[row])];
    area = double(pi) * length(cross(in_double(disk.along_x), in_double(disk.along_y)));
  } else {
    std::vector<double> areas;
    for (std::int32_t k = 0; k < geometry.triangles[row]; ++k)
      areas.push_back(triangle_area(corners(geometry, std::size_t(geometry.first_triangle[row] + k))));
    for (const double one : areas) area += one;
    triangles_ = make_alias_table(areas);
  }
  pdf_area_ = float(1 / area);
}

SurfaceSampling::Point SurfaceSampling::sample(const Vec2f& u) const {
  const auto inside = [](float x) { return x >= 0 ? std::min(x, 0x1.fffffep-1f) : 0; };
  const Vec2f at{inside(u.x), inside(u.y)};
  const auto row = std::size_t(id_);
  if (geometry_->sphere[row] >= 0) {
    const Sphere& sphere = geometry_->spheres[std::size_t(geometry_->sphere[row])];
    const Vec3f ng = square_to_uniform_sphere(at);
    return {sphere.center + ng * sphere.radius, ng};
  }
  if (geometry_->disk[row] >= 0) {
    const Disk& disk = geometry_->disks[std::size_t(geometry_->disk[row])];
    const Vec2f p = square_to_uniform_disk(at);
    return {disk.center + disk.along_x * p.x + disk.along_y * p.y, disk.ng};
  }
  return on_triangle(at);
}

SurfaceSampling::Point SurfaceSampling::on_triangle(const Vec2f& u) const {
  const auto u_triangle = std::uint32_t(double(u.y) * 0x1p32);
  const AliasSample<float> chosen = sample_alias<float>(triangles_.threshold.data(), triangles_.alias.data(),
                                                        0, std::int32_t(triangles_.size()), u_triangle);
  const std::array<Vec3f, 3> triangle =
      corners(*geometry_, std::size_t(geometry_->first_triangle[std::size_t(id_)] + chosen.index));
  const Vec3f along_1 = triangle[1] - triangle[0], along_2 = triangle[2] - triangle[0];
  const Vec2f barycentric = square_to_triangle(Vec2f{u.x, chosen.u_left});
  return {triangle[0] + along_1 * barycentric.x + along_2 * barycentric.y,
          normalize(cross(along_1, along_2))};
}

}  // namespace etendue

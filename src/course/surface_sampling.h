// Points uniform by area on one shape.
#pragma once

#include "base/alias_table.h"
#include "geometry/geometry.h"

#include <cstdint>

namespace etendue {

class SurfaceSampling {
 public:
  struct Point {
    Vec3f position;  ///< World, m.
    Vec3f ng;        ///< Unit, on the front side.
  };

  /// Of a mesh, a sphere or a disk with an area; `geometry` must outlive it.
  SurfaceSampling(const Geometry& geometry, std::int32_t id);

  /// \param u in the unit square; numbers outside of it are moved to its edge
  Point sample(const Vec2f& u) const;
  float pdf_area() const { return pdf_area_; }  ///< 1/m^2, of `sample`: one over the area.

 private:
  Point on_triangle(const Vec2f& u) const;

  const Geometry* geometry_;
  std::int32_t id_;
  AliasTable triangles_;  ///< Of a mesh, by area.
  float pdf_area_ = 0;
};

}  // namespace etendue

// A ray, or the part of one between two distances.
#pragma once

#include <nori/vector.h>

NORI_NAMESPACE_BEGIN

struct Ray3f {
  Point3f o;             ///< Where it starts (m, world).
  Vector3f d{0, 0, 1};   ///< Where it goes (world); distances along it count in lengths of d.
  float mint = Epsilon;  ///< Nothing nearer is met ...
  float maxt = std::numeric_limits<float>::infinity();  ///< ... and nothing farther.

  Ray3f() = default;
  Ray3f(const Point3f& o, const Vector3f& d) : o(o), d(d) {}
  Ray3f(const Point3f& o, const Vector3f& d, float mint, float maxt) : o(o), d(d), mint(mint), maxt(maxt) {}
  Ray3f(const Ray3f& ray, float mint, float maxt) : o(ray.o), d(ray.d), mint(mint), maxt(maxt) {}

  Point3f operator()(float t) const { return o + d * t; }
  Ray3f reverse() const { return {o, -d, mint, maxt}; }
};

NORI_NAMESPACE_END

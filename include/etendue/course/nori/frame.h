// An orthonormal frame: local coordinates in which z is a surface's normal.
#pragma once

#include <nori/vector.h>

NORI_NAMESPACE_BEGIN

struct Frame {
  Vector3f s{1, 0, 0}, t{0, 1, 0};
  Normal3f n{0, 0, 1};

  Frame() = default;
  Frame(const Vector3f& s, const Vector3f& t, const Normal3f& n) : s(s), t(t), n(n) {}
  /// Any two tangents. \param normal unit
  explicit Frame(const Vector3f& normal) : n(normal) {
    const Vector3f aside = std::abs(normal.x()) > 0.5f ? Vector3f(0, 1, 0) : Vector3f(1, 0, 0);
    t = normal.cross(aside).normalized();
    s = t.cross(normal);
  }

  Vector3f toLocal(const Vector3f& world) const { return {world.dot(s), world.dot(t), world.dot(n)}; }
  Vector3f toWorld(const Vector3f& local) const { return s * local.x() + t * local.y() + n * local.z(); }

  // Of the angle between a unit *local* direction and the normal.
  static float cosTheta(const Vector3f& local) { return local.z(); }
  static float sinTheta2(const Vector3f& local) { return std::max(1 - local.z() * local.z(), 0.0f); }
  static float sinTheta(const Vector3f& local) { return std::sqrt(sinTheta2(local)); }
  static float tanTheta(const Vector3f& local) { return sinTheta(local) / local.z(); }
};

NORI_NAMESPACE_END

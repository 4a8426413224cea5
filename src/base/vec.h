// Three-component vectors over any lane type, and the linear-algebra helpers the renderer needs.
#pragma once

#include <cmath>

namespace etendue {

/// A vector, point or normal; `T` is `float`, `double` or a batch of floats.
template <class T>
struct Vec3 {
  T x, y, z;

  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(const Vec3& a, const T& s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3 operator*(const T& s, const Vec3& a) { return a * s; }
  friend Vec3 operator/(const Vec3& a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

template <class T>
struct Vec2 {
  T x, y;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

using Vec3f = Vec3<float>;
using Vec2f = Vec2<float>;

inline Vec3f narrow(const Vec3<double>& v) { return {float(v.x), float(v.y), float(v.z)}; }
inline Vec3<double> widen(const Vec3f& v) { return {v.x, v.y, v.z}; }

template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
T length_sq(const Vec3<T>& a) {
  return dot(a, a);
}

template <class T>
T length(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

template <class T>
Vec3<T> normalize(const Vec3<T>& a) {
  return a * (T(1) / length(a));
}

}  // namespace etendue

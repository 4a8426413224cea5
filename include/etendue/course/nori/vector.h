// Vectors, points and normals of three floats, points of two. Each kind may be used where another is asked
// for.
#pragma once

#include <nori/common.h>

NORI_NAMESPACE_BEGIN

/// A difference of points (m), or a direction.
struct Vector3f {
  float values[3]{0, 0, 0};

  Vector3f() = default;
  explicit Vector3f(float all) : values{all, all, all} {}
  Vector3f(float x, float y, float z) : values{x, y, z} {}

  float x() const { return values[0]; }
  float y() const { return values[1]; }
  float z() const { return values[2]; }
  float& x() { return values[0]; }
  float& y() { return values[1]; }
  float& z() { return values[2]; }
  float operator[](int i) const { return values[i]; }
  float& operator[](int i) { return values[i]; }
  float operator()(int i) const { return values[i]; }
  float& operator()(int i) { return values[i]; }

  Vector3f operator-() const { return {-x(), -y(), -z()}; }
  Vector3f& operator+=(const Vector3f& v) { return *this = {x() + v.x(), y() + v.y(), z() + v.z()}; }
  Vector3f& operator-=(const Vector3f& v) { return *this = {x() - v.x(), y() - v.y(), z() - v.z()}; }
  Vector3f& operator*=(float f) { return *this = {x() * f, y() * f, z() * f}; }
  Vector3f& operator/=(float f) { return *this *= 1 / f; }
  bool operator==(const Vector3f& v) const { return x() == v.x() && y() == v.y() && z() == v.z(); }

  float dot(const Vector3f& v) const { return x() * v.x() + y() * v.y() + z() * v.z(); }
  Vector3f cross(const Vector3f& v) const {
    return {y() * v.z() - z() * v.y(), z() * v.x() - x() * v.z(), x() * v.y() - y() * v.x()};
  }
  float squaredNorm() const { return dot(*this); }
  float norm() const { return std::sqrt(squaredNorm()); }
  Vector3f normalized() const {
    Vector3f unit = *this;
    unit.normalize();
    return unit;
  }
  void normalize() { *this /= norm(); }

  float maxCoeff() const { return std::max({x(), y(), z()}); }
  float minCoeff() const { return std::min({x(), y(), z()}); }
  Vector3f cwiseAbs() const { return {std::abs(x()), std::abs(y()), std::abs(z())}; }
  bool isZero() const { return squaredNorm() == 0; }
};

inline Vector3f operator+(Vector3f a, const Vector3f& b) { return a += b; }
inline Vector3f operator-(Vector3f a, const Vector3f& b) { return a -= b; }
inline Vector3f operator*(Vector3f v, float f) { return v *= f; }
inline Vector3f operator*(float f, Vector3f v) { return v *= f; }
inline Vector3f operator/(Vector3f v, float f) { return v /= f; }
inline std::ostream& operator<<(std::ostream& out, const Vector3f& v) {
  return out << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
}

/// A place in the world, m.
struct Point3f : Vector3f {
  using Vector3f::Vector3f;
  Point3f() = default;
  Point3f(const Vector3f& v) : Vector3f(v) {}
};

/// A direction across a surface; unit where the framework gives one.
struct Normal3f : Vector3f {
  using Vector3f::Vector3f;
  Normal3f() = default;
  Normal3f(const Vector3f& v) : Vector3f(v) {}
};

/// A point of the unit square, or of a surface's own coordinates.
struct Point2f {
  float values[2]{0, 0};

  Point2f() = default;
  explicit Point2f(float both) : values{both, both} {}
  Point2f(float x, float y) : values{x, y} {}

  float x() const { return values[0]; }
  float y() const { return values[1]; }
  float& x() { return values[0]; }
  float& y() { return values[1]; }
  float operator[](int i) const { return values[i]; }
  float& operator[](int i) { return values[i]; }
  float operator()(int i) const { return values[i]; }
  float& operator()(int i) { return values[i]; }
};

inline Point2f operator+(const Point2f& a, const Point2f& b) { return {a.x() + b.x(), a.y() + b.y()}; }
inline Point2f operator-(const Point2f& a, const Point2f& b) { return {a.x() - b.x(), a.y() - b.y()}; }
inline Point2f operator*(const Point2f& p, float f) { return {p.x() * f, p.y() * f}; }
inline Point2f operator*(float f, const Point2f& p) { return p * f; }
inline std::ostream& operator<<(std::ostream& out, const Point2f& p) {
  return out << '[' << p.x() << ", " << p.y() << ']';
}

using Point2d = Point2f;  ///< The handouts' name of a sample: here of floats too.
using Vector2f = Point2f;

NORI_NAMESPACE_END

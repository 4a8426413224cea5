#include "base/transform.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace etendue {
namespace {

using Row = std::array<double, 3>;

/// The largest magnitude in the 3x3 block.
double largest_entry(const Transform& t) {
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(t.m[i][j]));
  return largest;
}

/// The matrix of cofactors of the 3x3 block: determinant x inverse transpose.
std::array<Row, 3> cofactors(const Transform& t) {
  std::array<Row, 3> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c[i][j] = t.m[i1][j1] * t.m[i2][j2] - t.m[i1][j2] * t.m[i2][j1];
    }
  return c;
}

/// The 3x3 block divided by its largest entry, so that no product over- or underflows.
Transform without_scale(const Transform& t, double largest) {
  Transform scaled = t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) scaled.m[i][j] /= largest;
  return scaled;
}

void set_column(Transform& t, int column, const Vec3<double>& v) {
  t.m[0][column] = v.x;
  t.m[1][column] = v.y;
  t.m[2][column] = v.z;
}

Vec3<double> normalize_or_zero(const Vec3<double>& v, double shortest) {
  const double norm = length(v);
  return norm > shortest ? v / norm : Vec3<double>{0, 0, 0};
}

}  // namespace

Transform operator*(const Transform& a, const Transform& b) {
  Transform product;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += a.m[i][k] * b.m[k][j];
      product.m[i][j] = sum;
    }
  return product;
}

Transform translation(const Vec3<double>& offset) {
  Transform t;
  set_column(t, 3, offset);
  return t;
}

Transform scaling(const Vec3<double>& factors) {
  Transform t;
  t.m[0][0] = factors.x;
  t.m[1][1] = factors.y;
  t.m[2][2] = factors.z;
  return t;
}

// Rodrigues: R v = v cos + (a x v) sin + a (a . v)(1 - cos), one column for each unit vector.
Transform rotation(const Vec3<double>& axis, double angle_deg) {
  const Vec3<double> a = normalize(axis);
  const double angle = angle_deg * (std::numbers::pi / 180);
  const double cos_angle = std::cos(angle), sin_angle = std::sin(angle);
  const auto rotate = [&](const Vec3<double>& v) {
    return v * cos_angle + cross(a, v) * sin_angle + a * (dot(a, v) * (1 - cos_angle));
  };
  Transform t;
  set_column(t, 0, rotate({1, 0, 0}));
  set_column(t, 1, rotate({0, 1, 0}));
  set_column(t, 2, rotate({0, 0, 1}));
  return t;
}

Transform look_at(const Vec3<double>& origin, const Vec3<double>& target, const Vec3<double>& up) {
  const Vec3<double> direction = normalize_or_zero(target - origin, 0);
  const Vec3<double> left = normalize_or_zero(cross(normalize_or_zero(up, 0), direction), 1e-12);
  Transform t;
  set_column(t, 0, left);
  set_column(t, 1, cross(direction, left));
  set_column(t, 2, direction);
  set_column(t, 3, origin);
  return t;
}

bool is_projection_to_z(const Transform& t) {
  const auto column = [&](std::size_t i) { return Vec3<double>{t.m[0][i], t.m[1][i], t.m[2][i]}; };
  const Vec3<double> zero{0, 0, 0};
  return column(0) == zero && column(1) == zero && column(2) != zero;
}

double determinant(const Transform& t) {
  const std::array<Row, 3> c = cofactors(t);
  return t.m[0][0] * c[0][0] + t.m[0][1] * c[0][1] + t.m[0][2] * c[0][2];
}

bool is_invertible(const Transform& t) {
  for (const auto& row : t.m)
    for (const double entry : row)
      if (!std::isfinite(entry)) return false;
  const double largest = largest_entry(t);
  if (largest < std::numeric_limits<double>::min()) return false;
  // Hadamard: |det| is at most the product of the norms of the rows, and of the columns. A determinant that
  // is only rounding next to both of them cannot be told from 0; a flat scale before or after a rotation
  // keeps one of them small.
  const Transform s = without_scale(t, largest);
  double rows = 1, columns = 1;
  for (int i = 0; i < 3; ++i) {
    rows *= std::hypot(s.m[i][0], s.m[i][1], s.m[i][2]);
    columns *= std::hypot(s.m[0][i], s.m[1][i], s.m[2][i]);
  }
  return std::abs(determinant(s)) > 8 * std::numeric_limits<double>::epsilon() * std::min(rows, columns);
}

Vec3<double> transform_point(const Transform& t, const Vec3<double>& p) {
  return transform_vector(t, p) + Vec3<double>{t.m[0][3], t.m[1][3], t.m[2][3]};
}

Vec3<double> transform_vector(const Transform& t, const Vec3<double>& v) {
  const auto& m = t.m;
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

Vec3<double> transform_normal(const Transform& t, const Vec3<double>& n) {
  const double largest = largest_entry(t);
  const Transform s = without_scale(t, largest);
  const std::array<Row, 3> c = cofactors(s);
  const double scale = 1 / (determinant(s) * largest);
  return Vec3<double>{c[0][0] * n.x + c[0][1] * n.y + c[0][2] * n.z,
                      c[1][0] * n.x + c[1][1] * n.y + c[1][2] * n.z,
                      c[2][0] * n.x + c[2][1] * n.y + c[2][2] * n.z} *
         scale;
}

}  // namespace etendue

// A colour: linear red, green and blue of Rec. 709, of radiance, of a BSDF, or of a factor between.
#pragma once

#include <nori/common.h>

NORI_NAMESPACE_BEGIN

/// What a comparison of colours gives, channel by channel.
struct Bool3 {
  bool r, g, b;
  bool any() const { return r || g || b; }
  bool all() const { return r && g && b; }
};

/// All operators work channel by channel.
struct Color3f {
  float values[3]{0, 0, 0};

  Color3f() = default;
  explicit Color3f(float all) : values{all, all, all} {}
  Color3f(float r, float g, float b) : values{r, g, b} {}

  float r() const { return values[0]; }
  float g() const { return values[1]; }
  float b() const { return values[2]; }
  float& r() { return values[0]; }
  float& g() { return values[1]; }
  float& b() { return values[2]; }
  float x() const { return values[0]; }
  float y() const { return values[1]; }
  float z() const { return values[2]; }
  float operator[](int i) const { return values[i]; }
  float& operator[](int i) { return values[i]; }
  float operator()(int i) const { return values[i]; }
  float& operator()(int i) { return values[i]; }

  Color3f operator-() const { return {-r(), -g(), -b()}; }
  Color3f& operator+=(const Color3f& c) { return *this = {r() + c.r(), g() + c.g(), b() + c.b()}; }
  Color3f& operator-=(const Color3f& c) { return *this = {r() - c.r(), g() - c.g(), b() - c.b()}; }
  Color3f& operator*=(const Color3f& c) { return *this = {r() * c.r(), g() * c.g(), b() * c.b()}; }
  Color3f& operator/=(const Color3f& c) { return *this = {r() / c.r(), g() / c.g(), b() / c.b()}; }
  Color3f& operator*=(float f) { return *this *= Color3f(f); }
  Color3f& operator/=(float f) { return *this /= Color3f(f); }

  float maxCoeff() const { return std::max({r(), g(), b()}); }
  float minCoeff() const { return std::min({r(), g(), b()}); }
  float sum() const { return r() + g() + b(); }
  float mean() const { return sum() / 3; }
  bool isZero() const { return r() == 0 && g() == 0 && b() == 0; }
  /// Every channel is finite and not negative.
  bool isValid() const {
    return std::all_of(values, values + 3, [](float c) { return std::isfinite(c) && c >= 0; });
  }
  float getLuminance() const { return r() * 0.212671f + g() * 0.715160f + b() * 0.072169f; }

  /// A colour is an array already: for `(color.array() != 0).any()`.
  const Color3f& array() const { return *this; }
  Bool3 operator==(float f) const { return {r() == f, g() == f, b() == f}; }
  Bool3 operator!=(float f) const { return {r() != f, g() != f, b() != f}; }
  Bool3 operator<(float f) const { return {r() < f, g() < f, b() < f}; }
  Bool3 operator<=(float f) const { return {r() <= f, g() <= f, b() <= f}; }
  Bool3 operator>(float f) const { return {r() > f, g() > f, b() > f}; }
  Bool3 operator>=(float f) const { return {r() >= f, g() >= f, b() >= f}; }
};

inline Color3f operator+(Color3f a, const Color3f& b) { return a += b; }
inline Color3f operator-(Color3f a, const Color3f& b) { return a -= b; }
inline Color3f operator*(Color3f a, const Color3f& b) { return a *= b; }
inline Color3f operator/(Color3f a, const Color3f& b) { return a /= b; }
inline Color3f operator*(Color3f c, float f) { return c *= f; }
inline Color3f operator*(float f, Color3f c) { return c *= f; }
inline Color3f operator/(Color3f c, float f) { return c /= f; }
inline std::ostream& operator<<(std::ostream& out, const Color3f& c) {
  return out << '[' << c.r() << ", " << c.g() << ", " << c.b() << ']';
}

NORI_NAMESPACE_END

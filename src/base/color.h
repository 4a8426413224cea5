// Linear Rec. 709 colour over any lane type.
#pragma once

namespace etendue {

/// Linear RGB (Rec. 709 primaries): a radiance, a reflectance or a weight, as the name of the variable says.
template <class T>
struct Color {
  T r, g, b;

  friend Color operator+(const Color& a, const Color& c) { return {a.r + c.r, a.g + c.g, a.b + c.b}; }
  friend Color operator*(const Color& a, const Color& c) { return {a.r * c.r, a.g * c.g, a.b * c.b}; }
  friend Color operator*(const Color& a, const T& s) { return {a.r * s, a.g * s, a.b * s}; }
  friend Color operator*(const T& s, const Color& a) { return a * s; }
  friend bool operator==(const Color&, const Color&) = default;
};

using Colorf = Color<float>;

/// Luminance of a linear Rec. 709 colour; weights as in the Nori family.
template <class T>
T luminance(const Color<T>& c) {
  return c.r * T(0.212671f) + c.g * T(0.715160f) + c.b * T(0.072169f);
}

}  // namespace etendue

// What every header of the course kit needs: names of the framework that the courses use, constants, errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#define NORI_NAMESPACE_BEGIN namespace nori {
#define NORI_NAMESPACE_END }

/// Classes that both the program and a module see must be the same class to both.
#define NORI_SHARED __attribute__((visibility("default")))

#ifndef M_PI
#define M_PI 3.14159265358979323846
#endif
#define INV_PI 0.31830988618379067154f
#define INV_TWOPI 0.15915494309189533577f
#define INV_FOURPI 0.07957747154594766788f

/// Where a framework marks what it does not use.
#define Q_UNUSED(x) (void)(x)

NORI_NAMESPACE_BEGIN

using std::cerr;
using std::cout;
using std::endl;

/// Rays start this far along their way (m) unless told otherwise, so that they miss the surface they leave.
inline constexpr float Epsilon = 1e-4f;

using QString = std::string;

/// Ends the render; the text is shown to the user.
class NORI_SHARED NoriException : public std::runtime_error {
 public:
  explicit NoriException(const std::string& text) : std::runtime_error(text) {}
};

inline float clamp(float value, float least, float most) { return std::min(std::max(value, least), most); }
inline float degToRad(float degrees) { return degrees * float(M_PI / 180); }
inline float radToDeg(float radians) { return radians * float(180 / M_PI); }

NORI_NAMESPACE_END

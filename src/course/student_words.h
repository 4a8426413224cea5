// Between the vectors and colours of the course kit and the renderer's.
#pragma once

#include "base/color.h"
#include "base/vec.h"

#include <nori/color.h>
#include <nori/vector.h>

namespace etendue {

inline Vec3f from_student(const nori::Vector3f& v) { return {v.x(), v.y(), v.z()}; }
inline Vec2f from_student(const nori::Point2f& p) { return {p.x(), p.y()}; }
inline Colorf from_student(const nori::Color3f& c) { return {c.r(), c.g(), c.b()}; }

inline nori::Vector3f to_student(const Vec3f& v) { return {v.x, v.y, v.z}; }
inline nori::Point2f to_student(const Vec2f& p) { return {p.x, p.y}; }
inline nori::Color3f to_student(const Colorf& c) { return {c.r, c.g, c.b}; }

}  // namespace etendue

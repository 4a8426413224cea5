#include "light/disk_light.h"

#include <cmath>

namespace etendue {

std::int32_t DiskLights::add(const Disk& disk) {
  for (const Vec3f& v : {disk.center, disk.along_x, disk.along_y, disk.ng})
    fields_.insert(fields_.end(), {v.x, v.y, v.z});
  pdf_area_.push_back(inv_pi / length(cross(disk.along_x, disk.along_y)));

  // A sheared disk is an ellipse, whose half axes are where cos t x + sin t y is longest and shortest.
  const Vec3<double> x = widen(disk.along_x), y = widen(disk.along_y);
  const double t = 0.5 * std::atan2(2 * dot(x, y), length_sq(x) - length_sq(y));
  const Vec3<double> longest = x * std::cos(t) + y * std::sin(t);
  // What is left of the other one is at a right angle to it.
  const Vec3<double> across = y * std::cos(t) - x * std::sin(t);
  for (const Vec3<double>& v : {longest, across - longest * (dot(across, longest) / length_sq(longest))})
    half_axes_.insert(half_axes_.end(), {float(v.x), float(v.y), float(v.z)});
  return pdf_area_.size() - 1;
}

}  // namespace etendue

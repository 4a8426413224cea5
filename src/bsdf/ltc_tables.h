// Linearly transformed cosines fitted to glossy lobes, by scripts/fit_ltc.py.
#pragma once

#include <array>

namespace etendue::ltc {

inline constexpr int roughnesses = 12;  ///< 2^(-k/2); of Phong's lobe sqrt(2 / (n + 2)).
inline constexpr int angles = 16;       ///< sqrt(1 - cos(theta)) of the viewer, evenly from 0 to 1.

/// M = R [[a, 0, c], [0, b, 0], [0, 0, 1]] in a frame with the mirror direction as z, y across the plane of
/// incidence and x in it, towards the normal; R turns z towards x by the tilt.
struct Entry {
  float a, b, c, tan_tilt;  ///< Over the roughness.
  float albedo;             ///< Of the lobe, without Fresnel's factor.
};
using Table = std::array<std::array<Entry, angles>, roughnesses>;

extern const Table ggx, beckmann, phong;

}  // namespace etendue::ltc

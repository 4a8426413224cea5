// ICC profiles for tests.
#pragma once

#include <array>
#include <lcms2.h>
#include <string>

namespace etendue::test {

/// Of RGB pixels with these primaries, white D65, and values that are light to the power 1 / gamma.
inline std::string rgb_profile(const std::array<std::array<double, 2>, 3>& xy, double gamma) {
  const cmsCIExyY white{0.3127, 0.329, 1};
  const cmsCIExyYTRIPLE primaries{{xy[0][0], xy[0][1], 1}, {xy[1][0], xy[1][1], 1}, {xy[2][0], xy[2][1], 1}};
  cmsToneCurve* const curve = cmsBuildGamma(nullptr, gamma);
  cmsToneCurve* const curves[]{curve, curve, curve};
  const cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(curve);
  return bytes;
}

inline constexpr std::array<std::array<double, 2>, 3> p3_primaries{
    {{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}}};

}  // namespace etendue::test

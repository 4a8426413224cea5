#include "image/icc_profile.h"

#include "image/color_space.h"
#include "image/unreadable.h"

#include <algorithm>
#include <array>
#include <lcms2.h>
#include <vector>

namespace etendue {

namespace {

using Profile = std::unique_ptr<void, decltype([](void* profile) { cmsCloseProfile(profile); })>;

Profile linear_rec709() {
  const auto xy = [](const Vec2<double>& p) { return cmsCIExyY{p.x, p.y, 1}; };
  const cmsCIExyY white = xy(rec709.white);
  const cmsCIExyYTRIPLE primaries{xy(rec709.primaries[0]), xy(rec709.primaries[1]), xy(rec709.primaries[2])};
  cmsToneCurve* const linear = cmsBuildGamma(nullptr, 1);
  cmsToneCurve* const curves[3]{linear, linear, linear};
  Profile profile(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(linear);
  return profile;
}

}  // namespace

struct IccProfile::Transform {
  bool is_grey;
  cmsHTRANSFORM transform;
  ~Transform() { cmsDeleteTransform(transform); }
};

IccProfile::IccProfile(std::span<const unsigned char> bytes) {
  const Profile profile(cmsOpenProfileFromMem(bytes.data(), cmsUInt32Number(bytes.size())));
  if (!profile) throw Unreadable("its colour profile is damaged; remove the profile");
  const cmsColorSpaceSignature space = cmsGetColorSpace(profile.get());
  const bool is_grey = space == cmsSigGrayData;
  if (!is_grey && space != cmsSigRgbData)
    throw Unreadable("its colour profile is not one of RGB or grey pixels; convert it to sRGB");
  const cmsHTRANSFORM transform =
      cmsCreateTransform(profile.get(), is_grey ? TYPE_GRAY_FLT : TYPE_RGB_FLT, linear_rec709().get(),
                         TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE);
  if (!transform) throw Unreadable("its colour profile cannot be used; convert it to sRGB");
  transform_.reset(new Transform{is_grey, transform});
}

IccProfile::~IccProfile() = default;

bool IccProfile::is_srgb() const {
  constexpr int steps = 8;
  std::vector<float> stored;
  for (int r = 0; r <= steps; ++r)
    for (int g = 0; g <= steps; ++g)
      for (int b = 0; b <= steps; ++b)
        for (const int level : transform_->is_grey ? std::array{r, r, r} : std::array{r, g, b})
          stored.push_back(float(level) / steps);
  std::vector<float> linear = stored;
  convert_to_rec709(linear);
  return std::equal(stored.begin(), stored.end(), linear.begin(),
                    [](float s, float l) { return std::abs(linear_from_srgb(s) - double(l)) < 1e-3; });
}

void IccProfile::convert_to_rec709(std::span<float> rgb) const {
  constexpr std::size_t most = 4096;  // Pixels at a time.
  std::vector<float> pixels;
  for (std::size_t begin = 0; begin < rgb.size(); begin += 3 * most) {
    const std::span<float> part = rgb.subspan(begin, std::min(3 * most, rgb.size() - begin));
    pixels.clear();
    for (std::size_t i = 0; i < part.size(); i += transform_->is_grey ? 3 : 1) pixels.push_back(part[i]);
    cmsDoTransform(transform_->transform, pixels.data(), part.data(), cmsUInt32Number(part.size() / 3));
    for (float& value : part) value = std::max(value, 0.0f);
  }
}

}  // namespace etendue

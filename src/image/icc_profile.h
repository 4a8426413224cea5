// A colour profile that an image file carries.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace etendue {

class IccProfile {
 public:
  /// Throws Unreadable for what is no profile of RGB or grey pixels.
  explicit IccProfile(std::span<const unsigned char> bytes);
  ~IccProfile();
  IccProfile(const IccProfile&) = delete;
  IccProfile& operator=(const IccProfile&) = delete;

  /// Its colours are those of sRGB within 0.1 % of white: there are many profiles of sRGB.
  bool is_srgb() const;
  /// Linear light with Rec. 709 primaries from pixels as stored, 0 to 1; relative colorimetric, so white
  /// stays white. A colour beyond Rec. 709 gets 0 where a channel would be negative.
  void convert_to_rec709(std::span<float> rgb) const;

 private:
  struct Transform;
  std::unique_ptr<Transform> transform_;
};

}  // namespace etendue

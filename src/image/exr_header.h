// The headers of an EXR file, checked before OpenEXR acts upon them.
#pragma once

#include <ImfHeader.h>
#include <ImfIO.h>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// The bytes of a file, for OpenEXR. Throws Unreadable where it would read beyond their end.
class ExrBytes : public Imf::IStream {
 public:
  explicit ExrBytes(std::span<const unsigned char> bytes) : IStream("image"), bytes_(bytes) {}
  bool read(char* to, int count) override;
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override;

 private:
  std::span<const unsigned char> bytes_;
  std::size_t position_ = 0;
};

/// Pixels.
inline std::size_t width_of(const Imath::Box2i& window) {
  return std::size_t(window.max.x - window.min.x + 1);
}
inline std::size_t height_of(const Imath::Box2i& window) {
  return std::size_t(window.max.y - window.min.y + 1);
}

struct ExrPart {
  Imf::Header header;
  std::string name;  ///< Empty in a file of a single part.
  bool is_deep, is_tiled;
};

/// One or more. Throws Unreadable for what is no EXR file, of an unknown version, or too short for what its
/// headers claim: OpenEXR allocates by them.
std::vector<ExrPart> read_exr_headers(std::span<const unsigned char> file);

/// Throws Unreadable unless a file of so many bytes can hold this part's pixels, and 2^31 values all of them
/// in its display window.
void check_exr_pixels(const ExrPart& part, std::size_t file_size);

}  // namespace etendue

// The formats that read_colors knows, each from the bytes of a file to colours.
#pragma once

#include "image/color_file.h"

#include <span>
#include <string_view>

namespace etendue {

using Bytes = std::span<const unsigned char>;

/// The whole file. Throws Unreadable where it is none, or too large to be held.
std::vector<unsigned char> bytes_of(const std::filesystem::path& file);

/// For messages: names in a corrupt file are arbitrary bytes.
std::string printable(std::string text);

/// A format by the bytes with which its files begin. `decode` throws Unreadable, or what std::exception of a
/// library says.
struct Decoder {
  std::string_view name;
  bool (*is_begun_by)(Bytes begin);  ///< Of the first 16 bytes of a file, or all where it is shorter.
  ColorImage (*decode)(Bytes file, const ColorRequest& request);
};
extern const Decoder exr_decoder, png_decoder, jpeg_decoder, hdr_decoder;

inline bool begins_with(Bytes bytes, std::string_view text) {
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).starts_with(text);
}

}  // namespace etendue

// Attribute names that mean something to EXR itself, so that metadata must leave them alone.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace etendue {

constexpr std::size_t exr_longest_name = 255;  ///< Bytes, of a channel or an attribute.

/// "OpenEXR File Layout", required attributes, plus those that only some kinds of file have.
inline bool is_exr_own_name(std::string_view name) {
  constexpr std::array<std::string_view, 16> own{"channels",
                                                 "chunkCount",
                                                 "compression",
                                                 "dataWindow",
                                                 "displayWindow",
                                                 "lineOrder",
                                                 "maxSamplesPerPixel",
                                                 "name",
                                                 "preview",
                                                 "pixelAspectRatio",
                                                 "screenWindowCenter",
                                                 "screenWindowWidth",
                                                 "tiles",
                                                 "type",
                                                 "version",
                                                 "view"};
  return std::find(own.begin(), own.end(), name) != own.end();
}

}  // namespace etendue

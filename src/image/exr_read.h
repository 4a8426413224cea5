// One part of an EXR file, as what its display window shows.
#pragma once

#include "image/exr_header.h"

namespace etendue {

/// Where the values of a channel go: rows of the data window, a value every `step` floats.
struct ExrTarget {
  std::string channel;
  float* first;
  std::size_t step;
};
/// Throws Unreadable, or what OpenEXR throws, for what cannot be read: deep parts and subsampled channels
/// among it. \param parts all of the file; that of `number` passed check_exr_pixels
void read_exr_channels(std::span<const unsigned char> file, const std::vector<ExrPart>& parts,
                       std::size_t number, const std::vector<ExrTarget>& targets);

/// Rows of the display window from rows of the data window, `values` numbers a pixel: 0 beside the data, and
/// what lies beside the display window is left out.
std::vector<float> in_display_window(const Imf::Header& header, std::vector<float> data, std::size_t values);

}  // namespace etendue

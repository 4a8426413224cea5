// An image file that a scene names, as colours: for textures and environment maps.
#pragma once

#include "image/image_file.h"
#include "scenefile/parameters.h"

#include <array>
#include <filesystem>

namespace etendue {

struct ColorImage {
  Image image;
  std::array<std::size_t, 3> rgb;  ///< Which of its channels; three times the same of a grey image.

  float value(std::size_t pixel, std::size_t channel) const {
    return image.channels[rgb[channel]].values[pixel];
  }
};

/// The EXR or PNG that the parameter `name` names, relative to `directory`; `encoding` is that of a PNG.
/// Throws InputError where it is not there, not such an image, or without R, G and B, or Y, or a single
/// channel.
ColorImage read_color_image(const Parameters& parameters, std::string_view name,
                            const std::filesystem::path& directory, PngEncoding encoding);

}  // namespace etendue

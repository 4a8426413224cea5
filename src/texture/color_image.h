// An image file that a scene names, as colours: for textures and environment maps.
#pragma once

#include "image/color_file.h"
#include "scenefile/parameters.h"

#include <filesystem>
#include <string_view>

namespace etendue {

/// The image that the parameter `name` names, relative to `directory`; the layer that the parameter 'layer'
/// states. Throws InputError where it is not there, or cannot be read as asked.
ColorImage read_color_image(const Parameters& parameters, std::string_view name,
                            const std::filesystem::path& directory, bool is_raw);

}  // namespace etendue

// A file that a scene names.
#pragma once

#include "scenefile/parameters.h"

#include <filesystem>
#include <string_view>

namespace etendue {

/// The file that the parameter `name` names, relative to `directory`. Throws InputError where it is not there
/// or a folder. \param wanted for the message: "an OBJ file"
std::filesystem::path existing_file(const Parameters& parameters, std::string_view name,
                                    const std::filesystem::path& directory, std::string_view wanted);

}  // namespace etendue

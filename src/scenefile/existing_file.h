// A file that another one names.
#pragma once

#include "scenefile/parameters.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace etendue {

/// directory / stated. Throws InputError, at `where`, where it is not there or a folder; the message knows
/// capitals and backslashes.
/// \param wanted for the message: "an OBJ file"
/// \param relative_to whose folder `directory` is, for the message
std::filesystem::path existing_file(const std::string& stated, const Location& where,
                                    const std::filesystem::path& directory, std::string_view wanted,
                                    std::string_view relative_to);

/// The same for the file that the parameter `name` names, relative to the scene file's `directory`.
std::filesystem::path existing_file(const Parameters& parameters, std::string_view name,
                                    const std::filesystem::path& directory, std::string_view wanted);

}  // namespace etendue

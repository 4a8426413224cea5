// A file as it is, byte for byte.
#pragma once

#include "base/error.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace etendue {

/// All of the file. Throws InputError where it is missing, no regular file, or cannot be read.
/// \param kind for messages: "an OBJ mesh"
std::shared_ptr<const SourceFile> read_whole_file(const std::filesystem::path& file, std::string_view kind);

}  // namespace etendue

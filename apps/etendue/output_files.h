// Files that commands write: never over what is read, nor one thing twice.
#pragma once

#include "scenefile/scene_desc.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue::app {

/// The scene file itself, and what its `filename` keys name.
std::vector<std::filesystem::path> files_of(const SceneDesc& description,
                                            const std::filesystem::path& scene_file);

/// Throws InputError where a file to be written is one of those read, or stands in the list twice.
void check_overwrites_nothing(const std::vector<std::string>& written,
                              const std::vector<std::filesystem::path>& read);

/// The whole of it or nothing, as TemporaryFile does. Throws InputError with the path and the reason.
void write_text_file(const std::filesystem::path& file, const std::string& text);

}  // namespace etendue::app

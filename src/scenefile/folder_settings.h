// What a folder says once for all scenes in it and below: the file etendue.json.
#pragma once

#include "scenefile/scene_desc.h"

#include <filesystem>
#include <optional>

namespace etendue {

struct FolderSettings {
  std::filesystem::path file;
  std::optional<Dialect> dialect;
};

/// Of the nearest etendue.json: in the folder of `scene_file`, or in one above it. Throws InputError for one
/// that is not JSON, has an unknown key, or a value that makes no sense.
std::optional<FolderSettings> folder_settings_of(const std::filesystem::path& scene_file);

}  // namespace etendue

// All the files that a scene is made of.
#pragma once

#include "scenefile/scene_desc.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace etendue {

/// What the `filename` keys of a scene name, in the order of the scene file, then the libraries of materials
/// of its meshes, each file once. A mesh that was split by its materials has their textures among its keys.
std::vector<std::filesystem::path> files_named_by(const SceneDesc& description);

/// Of the dialect and the content of the scene file, and of all files that it names, in its order: scenes of
/// the same hash give the same image. Throws InputError where a file cannot be read.
std::uint64_t scene_hash(const SceneDesc& description);

}  // namespace etendue

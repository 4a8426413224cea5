// The mesh files that a scene names, each read once.
#pragma once

#include "geometry/mesh.h"
#include "scenefile/scene_desc.h"

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>

namespace etendue {

/// Keeps what a file says from its first use to its last.
class MeshFiles {
 public:
  /// \param root the scene, whose shapes' filenames are counted
  explicit MeshFiles(const Object& root);

  /// \param usemtl as of MeshFile
  /// \param read_file read_obj_file or read_ply_file, where `file` has not been read yet
  Mesh read(const Object& shape, const std::filesystem::path& file, const Transform& world_from_object,
            const std::optional<std::string>& usemtl, MeshFile (*read_file)(const std::filesystem::path&));

 private:
  struct Use {
    std::size_t left = 0;
    MeshFile file;
  };
  std::unordered_map<std::string, Use> uses_;  ///< By type and filename, as stated.
};

}  // namespace etendue

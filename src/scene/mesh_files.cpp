#include "scene/mesh_files.h"

#include <utility>
#include <variant>

namespace etendue {
namespace {

/// Empty where the object names no file.
std::string key_of(const Object& shape) {
  for (const Property& property : shape.properties)
    if (const auto* name = std::get_if<std::string>(&property.value); name && property.name == "filename")
      return shape.type + ' ' + *name;
  return {};
}

}  // namespace

MeshFiles::MeshFiles(const Object& root) {
  for (const Object& shape : root.children)
    if (const std::string key = key_of(shape); !key.empty()) ++uses_[key].left;
}

Mesh MeshFiles::read(const Object& shape, const std::filesystem::path& file,
                     const Transform& world_from_object, const std::optional<std::string>& usemtl,
                     MeshFile (*read_file)(const std::filesystem::path&)) {
  Use& use = uses_[key_of(shape)];
  if (!use.file) use.file = read_file(file);
  if (use.left > 1) {
    --use.left;
    return use.file(world_from_object, usemtl);
  }
  const MeshFile last = std::exchange(use.file, nullptr);
  return last(world_from_object, usemtl);
}

}  // namespace etendue

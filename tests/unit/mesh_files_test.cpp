// Mesh files that several shapes use: read once, and forgotten after the last.
#include "scene/mesh_files.h"

#include "base/transform.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

int files_read = 0;

MeshFile read_nothing(const std::filesystem::path& file) {
  ++files_read;
  return [name = file.string()](const Transform& world_from_object,
                                const std::optional<std::string>& /*usemtl*/) {
    const auto p = transform_point(world_from_object, {0, 0, 0});
    Mesh mesh;
    mesh.name = name;
    mesh.positions = {{float(p.x), float(p.y), float(p.z)}};
    return mesh;
  };
}

Object shape_of_file(const std::string& type, const std::string& file) {
  Object object;
  object.type = type;
  object.properties.push_back({"filename", "string", file, {}, {}});
  return object;
}

TEST(MeshFiles, EachFileIsReadOnceForAllItsShapes) {
  Object root;
  root.children = {shape_of_file("obj", "a"), shape_of_file("obj", "b"), shape_of_file("obj", "a"),
                   shape_of_file("ply", "a"), shape_of_file("obj", "a")};
  MeshFiles files(root);
  files_read = 0;
  float x = 0;
  for (const Object& child : root.children) {
    const std::string name = std::get<std::string>(child.properties[0].value);
    const Mesh mesh = files.read(child, name, translation({++x, 0, 0}), {}, read_nothing);
    EXPECT_EQ(mesh.name, name);
    EXPECT_EQ(mesh.positions[0].x, x);
  }
  EXPECT_EQ(files_read, 3);
  // All are forgotten: their memory is free for what comes.
  files.read(root.children[0], "a", {}, {}, read_nothing);
  EXPECT_EQ(files_read, 4);
}

}  // namespace
}  // namespace etendue

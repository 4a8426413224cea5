#include "scenefile/obj_materials.h"

#include "scenefile/existing_file.h"
#include "scenefile/mtl_reader.h"
#include "scenefile/obj_cursor.h"
#include "scenefile/text_file.h"
#include "scenefile/whole_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

namespace etendue {
namespace {

namespace fs = std::filesystem;

struct Named {
  std::string name;  ///< Empty: the faces before the first usemtl.
  Location where;
};

/// What an OBJ file says of materials.
struct ObjMaterials {
  std::vector<Named> libraries;  ///< As mtllib lists them.
  std::vector<Named> used;       ///< Those with faces, by their first.
};

template <class T>
const T* value_of_property(const Object& object, std::string_view name) {
  for (const Property& property : object.properties)
    if (property.name == name) return std::get_if<T>(&property.value);
  return nullptr;
}

Location place_of_property(const Object& object, std::string_view name) {
  for (const Property& property : object.properties)
    if (property.name == name) return property.value_location;
  return object.location;
}

class Splitter {
 public:
  explicit Splitter(SceneDesc& scene) : scene_(scene) {}

  void split_inside(Object& parent) {
    const auto asks = [](const Object& object) {
      const bool* materials = value_of_property<bool>(object, "materials");
      return object.type == "obj" && materials && *materials;
    };
    if (std::none_of(parent.children.begin(), parent.children.end(), asks)) {
      for (Object& child : parent.children)
        if (child.family == "scene") split_inside(child);
      return;
    }
    std::vector<Object> children;
    for (Object& child : parent.children)
      if (asks(child))
        split(std::move(child), children);
      else
        children.push_back(std::move(child));
    parent.children = std::move(children);
  }

 private:
  void split(Object mesh, std::vector<Object>& parts) {
    const std::string* filename = value_of_property<std::string>(mesh, "filename");
    std::error_code error;
    if (!filename || !fs::is_regular_file(scene_.directory / *filename, error)) {
      parts.push_back(std::move(mesh));
      return;
    }
    const ObjMaterials& obj = materials_of(*filename);
    if (obj.libraries.empty())
      throw InputError(place_of_property(mesh, "materials"),
                       fmt::format("'{}' names no library of materials", *filename),
                       "it has no mtllib statement; export it with its materials");
    const std::string* only = value_of_property<std::string>(mesh, "usemtl");
    bool is_own_used = false;
    for (const Named& used : obj.used) {
      if (only && *only != used.name) continue;
      Object part = mesh;
      std::erase_if(part.properties,
                    [](const Property& p) { return p.name == "materials" || p.name == "usemtl"; });
      // The place is not that of the OBJ file, which may be large and would be kept for it.
      const Location where = place_of_property(mesh, "filename");
      part.properties.push_back({"usemtl", "string", used.name, where, where});
      if (const MtlMaterial* material = find(obj, *filename, used)) {
        part.name = fmt::format("{} {}", mesh.name.empty() ? fs::path(*filename).stem().string() : mesh.name,
                                used.name);
        part.children = {material->bsdf};
        if (material->emitter) part.children.push_back(*material->emitter);
      } else {
        is_own_used = true;
      }
      parts.push_back(std::move(part));
    }
    if (!is_own_used && !mesh.children.empty())
      scene_.warnings.push_back(format_message(
          mesh.children.front().location,
          fmt::format("this has no effect: all faces of '{}' have a material of their own", *filename),
          "what stands in a mesh with materials is for the faces that have none"));
  }

  /// Null where the faces have none, or no library has it.
  const MtlMaterial* find(const ObjMaterials& obj, const std::string& filename, const Named& used) {
    if (used.name.empty()) return nullptr;
    std::vector<std::string> known;
    for (const Named& named : obj.libraries)
      for (const MtlMaterial& material : library(filename, named).materials) {
        if (material.name == used.name) return &material;
        known.push_back(material.name);
      }
    scene_.warnings.push_back(format_message(
        used.where, fmt::format("no library of this file has the material '{}'", used.name),
        known_names(used.name, known) +
            "; its faces have the bsdf and emitter that stand in the mesh, or are diffuse grey"));
    return nullptr;
  }

  const MtlLibrary& library(const std::string& filename, const Named& named) {
    const fs::path name = fs::path(filename).parent_path() / named.name;
    const auto known = libraries_.find(name);
    if (known != libraries_.end()) return known->second;
    scene_.material_libraries.push_back(existing_file(named.name, named.where,
                                                      scene_.directory / fs::path(filename).parent_path(),
                                                      "a library of materials", "the OBJ file"));
    MtlLibrary& read = libraries_.emplace(name, read_mtl(scene_.directory, name)).first->second;
    for (std::string& warning : read.warnings) scene_.warnings.push_back(std::move(warning));
    return read;
  }

  const ObjMaterials& materials_of(const std::string& filename) {
    const auto known = obj_files_.find(filename);
    if (known != obj_files_.end()) return known->second;
    return obj_files_.emplace(filename, scan(filename)).first->second;
  }

  ObjMaterials scan(const std::string& filename) const {
    const auto source = read_whole_file(scene_.directory / filename, "an OBJ mesh");
    ObjMaterials found;
    Named current;
    bool is_current_used = false;
    for (ObjCursor cursor(source->text, 0); !cursor.at_end(); cursor.skip_line()) {
      cursor.skip_blanks();
      if (cursor.accept("f")) {
        if (!std::exchange(is_current_used, true)) add_new(found.used, current);
      } else if (cursor.accept("usemtl")) {
        current = take_name(cursor, source);
        is_current_used = false;
      } else if (cursor.accept("mtllib")) {
        add_libraries(found.libraries, filename, take_name(cursor, source));
      }
    }
    return found;
  }

  static Named take_name(ObjCursor& cursor, const std::shared_ptr<const SourceFile>& source) {
    cursor.skip_blanks();
    const std::size_t offset = cursor.offset();
    const std::string_view name = cursor.take_rest();
    return {as_utf8(name), {source, offset, std::max<std::size_t>(name.size(), 1)}};
  }

  static void add_new(std::vector<Named>& all, const Named& named) {
    const auto is_same = [&](const Named& known) { return known.name == named.name; };
    if (std::none_of(all.begin(), all.end(), is_same)) all.push_back(named);
  }

  /// One statement lists several files, split by blanks, unless there is a file of all its words.
  void add_libraries(std::vector<Named>& libraries, const std::string& filename, const Named& stated) const {
    std::error_code error;
    const fs::path folder = scene_.directory / fs::path(filename).parent_path();
    if (fs::exists(folder / stated.name, error)) {
      add_new(libraries, stated);
      return;
    }
    ObjCursor cursor(stated.name, 0);
    for (cursor.skip_blanks(); !cursor.at_end(); cursor.skip_blanks())
      add_new(libraries, {std::string(cursor.take_token()), stated.where});
  }

  SceneDesc& scene_;
  std::map<std::string, ObjMaterials> obj_files_;
  std::map<fs::path, MtlLibrary> libraries_;  ///< By their names, relative to the scene file.
};

}  // namespace

void split_by_materials(SceneDesc& scene) { Splitter(scene).split_inside(scene.root); }

}  // namespace etendue

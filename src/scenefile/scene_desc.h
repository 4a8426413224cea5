// What the user wrote: a tree of objects with properties, each with its place in the file.
#pragma once

#include "base/color.h"
#include "base/error.h"
#include "base/transform.h"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

/// The generation of the Nori family a file is read as; they differ in the sign of film x and in names.
enum class Dialect { nori_2012, nori_eth, nori };

/// One `<float name="fov" value="30"/>`; the alternatives are the types a file can state.
struct Property {
  using Value = std::variant<bool, int, double, std::string, Colorf, Vec3<double>, Transform, Vec2<double>>;
  std::string name;
  std::string tag;  ///< As written: boolean, integer, float, string, color, point, vector, transform.
  Value value;
  Location name_location, value_location;  ///< Without the quotes; the tag where the element has no `value`.
};

/// One element that names a plugin, e.g. `<bsdf type="phong">`, with what is inside it in file order.
struct Object {
  std::string family;  ///< The tag: scene, mesh, bsdf, luminaire, camera ...
  std::string type;    ///< The plugin, empty where the tag has none (scene).
  std::string name;    ///< The `name` attribute, empty where there is none.
  Location location, type_location;
  std::vector<Property> properties;
  std::vector<Object> children;
};

/// A parsed file. Paths in it are relative to `directory`.
struct SceneDesc {
  Object root;
  Dialect dialect = Dialect::nori_2012;
  std::string dialect_reason;  ///< Why this dialect, for the log.
  std::filesystem::path directory;
  std::vector<std::string> warnings;      ///< Complete messages: what was left out of `root`.
  bool is_dialect_told = true;            ///< False where it is only assumed.
  std::filesystem::path settings_file{};  ///< The etendue.json that was read; empty: there is none.
  std::vector<std::filesystem::path> material_libraries{};  ///< The MTL files that were read.
};

}  // namespace etendue
